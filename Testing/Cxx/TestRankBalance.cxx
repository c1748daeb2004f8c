// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Blocks that go from rank to rank, until all have as much to do.
#include "Core/Common/RankLists.h"
#include "Core/Evolution/MeshPiece.h"
#include "Core/Surface/RankBlocks.h"
#include "CoreTestTools.h"
#include "ThreadRanks.h"

using namespace volumic;

namespace
{
constexpr float Side = 24.f;
constexpr float Delta = 1.f;
constexpr int PlaceOnlyOwnersKnow = 1000000;

/** Spheres in a row along z, and as many beside them. */
SurfaceMesh Row()
{
  SurfaceMesh mesh;
  for (int i = 0; i < 6; ++i)
  {
    for (const double x : { 20., 75. })
    {
      mesh.Append(MakeSphere({ x, 20., 28. + 36. * i }, 15., 1.7).ToIndexed());
    }
  }
  return mesh;
}

SurfaceBlocks::Frame FrameOfRow()
{
  return SurfaceBlocks::FrameOf({ 96., 40., 220. }, Side);
}

/** The spheres in pieces, of which one has active vertices in the upper half only. */
class Pieces
{
public:
  explicit Pieces(Communicator& ranks)
  {
    this->State.Sizing = SizingField(Delta);
    if (ranks.Rank() == 0)
    {
      this->State.Mesh = Row();
    }
    this->State.Reset(this->Low, this->High);
    this->Blocks = std::make_unique<SurfaceBlocks>(this->State, FrameOfRow(), OnThisThread());
    this->Owned = std::make_unique<RankBlocks>(this->State, *this->Blocks, ranks);
    const SurfaceMesh mesh = std::exchange(this->State.Mesh, SurfaceMesh());
    std::vector<int> all(mesh.Rings.size());
    std::iota(all.begin(), all.end(), 0);
    this->Owned->ChooseOwners(mesh, all);
    this->Owned->Scatter(mesh, all, this->Low, this->High);
    std::vector<int> inner; // Of the others a rank does not know the shape.
    for (int v = 0; v < this->State.Mesh.Size(); ++v)
    {
      const Ring& ring = this->State.Mesh.Rings[v];
      const auto isHere = [this](int w) { return this->State.Mesh.IsAlive(w); };
      if (isHere(v))
      {
        this->State.Active[v] = this->State.Mesh.Position[v].Z > 118.f;
        if (std::all_of(ring.Item, ring.Item + ring.Count, isHere))
        {
          inner.push_back(v);
        }
      }
    }
    this->State.UpdateShape(inner, OnThisThread());
    this->Owned->AddPlaces(OnThisThread());
    for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
    {
      if (this->Owned->IsOwn(block))
      {
        this->Blocks->GiveBack(block, PlaceOnlyOwnersKnow + block);
      }
    }
  }

  std::int64_t OwnWork() const
  {
    std::int64_t work = 0;
    for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
    {
      work += this->Owned->IsOwn(block) ? this->Blocks->WorkOf(block, true) : 0;
    }
    return work;
  }

  Vector Low{ -10.f, -10.f, -10.f };
  Vector High{ 110.f, 60.f, 240.f };
  SurfaceState State;
  std::unique_ptr<SurfaceBlocks> Blocks;
  std::unique_ptr<RankBlocks> Owned;
};

/** What one rank would have, by place. */
SurfaceState& Whole()
{
  static SurfaceState whole;
  if (whole.Mesh.Size() == 0)
  {
    whole.Sizing = SizingField(Delta);
    whole.Mesh = Row();
    whole.Reset(Vector(-10.f, -10.f, -10.f), Vector(110.f, 60.f, 240.f));
    std::vector<int> all(static_cast<std::size_t>(whole.Mesh.Size()));
    std::iota(all.begin(), all.end(), 0);
    whole.UpdateShape(all, OnThisThread());
  }
  return whole;
}

std::vector<RankBlocks::Load> UnevenLoads(const SurfaceBlocks& blocks)
{
  std::vector<RankBlocks::Load> loads(static_cast<std::size_t>(blocks.NumberOfBlocks()));
  for (std::size_t b = 0; b < loads.size(); ++b)
  {
    const std::int64_t work = b % 7 == 3 ? 0 : 10 + 90 * static_cast<std::int64_t>(b) / 100;
    loads[b] = { work, 100 };
  }
  return loads;
}
}

TEST(RankBalance, SharesTheWork)
{
  SurfaceState state;
  state.Reset(Vector(), Vector(500.f, 300.f, 400.f));
  const SurfaceBlocks blocks(state, SurfaceBlocks::FrameOf({ 500., 300., 400. }, Side), OnThisThread());
  const std::vector<RankBlocks::Load> loads = UnevenLoads(blocks);
  std::int64_t most = 0;
  std::int64_t all = 0;
  for (const RankBlocks::Load& load : loads)
  {
    most = std::max(most, load.Work);
    all += load.Work;
  }
  const std::vector<int> nobodys(loads.size(), 0);
  for (const int ranks : { 1, 2, 3, 8, 13 })
  {
    SCOPED_TRACE(ranks);
    const std::vector<int> owners = RankBlocks::BalancedOwners(blocks, loads, nobodys, ranks);
    std::vector<std::int64_t> ofRanks(static_cast<std::size_t>(ranks), 0);
    for (std::size_t b = 0; b < loads.size(); ++b)
    {
      ofRanks[owners[b]] += loads[b].Work;
    }
    // A cut is at most half a block off, and each rank is at the end of as many as halvings.
    const int halvings = static_cast<int>(std::ceil(std::log2(ranks)));
    for (const std::int64_t ofRank : ofRanks)
    {
      EXPECT_NEAR(ofRank, all / ranks, halvings * most + 0.01 * all / ranks);
    }
    EXPECT_EQ(RankBlocks::WorkOfSweep(loads, owners, ranks),
      *std::max_element(ofRanks.begin(), ofRanks.end()));
    // Who has his share keeps his blocks.
    EXPECT_EQ(RankBlocks::BalancedOwners(blocks, loads, owners, ranks), owners);
  }
}

TEST(RankBalance, LeavesBlocksWithoutVerticesWhereTheyAre)
{
  SurfaceState state;
  state.Reset(Vector(), Vector(300.f, 300.f, 300.f));
  const SurfaceBlocks blocks(state, SurfaceBlocks::FrameOf({ 300., 300., 300. }, Side), OnThisThread());
  std::vector<RankBlocks::Load> loads = UnevenLoads(blocks);
  std::vector<int> before(loads.size(), 0);
  for (std::size_t b = 0; b < loads.size(); ++b)
  {
    before[b] = static_cast<int>(b % 2);
    if (b % 3 == 0)
    {
      loads[b] = RankBlocks::Load();
    }
  }
  const std::vector<int> owners = RankBlocks::BalancedOwners(blocks, loads, before, 2);
  EXPECT_NE(owners, before);
  for (std::size_t b = 0; b < loads.size(); b += 3)
  {
    EXPECT_EQ(owners[b], before[b]);
  }
}

TEST(RankBalance, CutsAlongTheAxisThatMovesFewBlocks)
{
  SurfaceState state;
  state.Reset(Vector(), Vector(168.f, 168.f, 168.f));
  const SurfaceBlocks blocks(state, SurfaceBlocks::FrameOf({ 168., 168., 168. }, Side), OnThisThread());
  const std::vector<RankBlocks::Load> loads(
    static_cast<std::size_t>(blocks.NumberOfBlocks()), { 10, 100 });
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<int> before(loads.size());
    for (int block = 0; block < blocks.NumberOfBlocks(); ++block)
    {
      before[block] = blocks.PlaceOf(block)[axis] >= 4;
    }
    EXPECT_EQ(RankBlocks::BalancedOwners(blocks, loads, before, 2), before) << axis;
  }
}

TEST(RankBalance, MovesBlocksToRanksThatHaveLessToDo)
{
  for (const int count : { 2, 4 })
  {
    SCOPED_TRACE(count);
    ThreadRanks::Run(count,
      [&](Communicator& ranks)
      {
        Pieces pieces(ranks);
        const std::int64_t before = pieces.OwnWork();
        EXPECT_TRUE(pieces.Owned->Balance(true, OnThisThread()));
        const auto most = [&ranks](std::int64_t work)
        {
          const std::vector<std::int64_t> all = GatherValues(ranks, work);
          return *std::max_element(all.begin(), all.end());
        };
        EXPECT_LT(most(pieces.OwnWork()), most(before));
        EXPECT_FALSE(pieces.Owned->Balance(true, OnThisThread()));
      });
  }
}

TEST(RankBalance, BringsAllThatIsKnownOfBlocksAndTheirNeighbourhood)
{
  const SurfaceState& whole = Whole();
  ThreadRanks::Run(2,
    [&](Communicator& ranks)
    {
      Pieces pieces(ranks);
      EXPECT_TRUE(pieces.Owned->Balance(true, OnThisThread()));
      const SurfaceState& s = pieces.State;
      const float halo = SurfaceBlocks::HaloInDelta * Delta;
      int own = 0;
      for (int v = 0; v < whole.Mesh.Size(); ++v)
      {
        const Vector& position = whole.Mesh.Position[v];
        bool isNear = false;
        pieces.Blocks->VisitNear(
          position, halo, [&](int block) { isNear = isNear || pieces.Owned->IsOwn(block); });
        EXPECT_EQ(s.Mesh.IsAlive(v), isNear) << v;
        if (!isNear || !s.Mesh.IsAlive(v)) // No ASSERT: the others would wait.
        {
          continue;
        }
        EXPECT_EQ(SquaredDistance(s.Mesh.Position[v], position), 0.f);
        EXPECT_EQ(s.Mesh.Rings[v].Count, whole.Mesh.Rings[v].Count);
        EXPECT_EQ(s.Active[v] != 0, position.Z > 118.f);
        if (pieces.Owned->IsOwnVertex(v))
        {
          EXPECT_EQ(s.Normal[v].X, whole.Normal[v].X);
          EXPECT_EQ(s.EdgeLengthSum[v], whole.EdgeLengthSum[v]);
        }
        bool isInGrid = false;
        s.Grid.Visit(position, 0.1f, [&](int w) { isInGrid = isInGrid || w == v; });
        EXPECT_TRUE(isInGrid);
        own += pieces.Owned->IsOwnVertex(v);
      }
      int all = 0;
      for (const int ofRank : GatherValues(ranks, own))
      {
        all += ofRank;
      }
      EXPECT_EQ(all, whole.Mesh.Size());
      // Their places have come along: none is missing any, and each is one rank's.
      std::vector<int> places;
      for (int block = 0; block < pieces.Blocks->NumberOfBlocks(); ++block)
      {
        if (pieces.Owned->IsOwn(block))
        {
          EXPECT_EQ(pieces.Blocks->MissingPlaces(block), 0);
          const BlockVisit visit = pieces.Blocks->Open(block);
          EXPECT_EQ(
            visit.Share.Places.Free, std::vector<int>(1, PlaceOnlyOwnersKnow + block));
          for (int v = visit.Share.Unused.Next; v < visit.Share.Unused.End; ++v)
          {
            places.push_back(v);
          }
        }
      }
      places = GatherListsOnAll(ranks, places);
      std::sort(places.begin(), places.end());
      EXPECT_GT(places.size(), 0u);
      EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
    });
}

TEST(RankBalance, KeepsAllVerticesWhenBlocksMove)
{
  const SurfaceState& whole = Whole();
  ThreadRanks::Run(4,
    [&](Communicator& ranks)
    {
      Pieces pieces(ranks);
      EXPECT_TRUE(pieces.Owned->Balance(true, OnThisThread()));
      std::vector<int> own;
      for (int v = 0; v < whole.Mesh.Size(); ++v)
      {
        if (pieces.State.Mesh.IsAlive(v) && pieces.Owned->IsOwnVertex(v))
        {
          own.push_back(v);
        }
      }
      const SurfaceMesh united = GatherMesh(ranks, pieces.State.Mesh, own);
      // It has the places, too, that blocks keep for new vertices.
      const int all = ranks.Rank() == 0 ? whole.Mesh.Size() : 0;
      EXPECT_EQ(united.NumberOfVertices(), all);
      EXPECT_EQ(united.Size() == 0, all == 0);
      for (int v = 0; v < all; ++v)
      {
        EXPECT_EQ(SquaredDistance(united.Position[v], whole.Mesh.Position[v]), 0.f);
        const Ring& ring = united.Rings[v];
        EXPECT_EQ(std::vector<int>(ring.Item, ring.Item + ring.Count),
          std::vector<int>(whole.Mesh.Rings[v].Item,
            whole.Mesh.Rings[v].Item + whole.Mesh.Rings[v].Count));
      }
    });
}

TEST(RankBalance, VisitsFirstWhatOthersWaitFor)
{
  SurfaceState state;
  state.Reset(Vector(), Vector(240.f, 240.f, 240.f));
  SurfaceBlocks blocks(state, SurfaceBlocks::FrameOf({ 240., 240., 240. }, Side), OnThisThread());
  std::vector<int> colours(static_cast<std::size_t>(blocks.NumberOfBlocks()));
  for (int colour = 0; colour < SurfaceBlocks::Colours; ++colour)
  {
    for (const int block : blocks.ByColour()[colour])
    {
      colours[block] = colour;
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    SCOPED_TRACE(axis);
    ThreadRanks::Run(2,
      [&](Communicator& ranks)
      {
        SurfaceState own;
        RankBlocks owned(own, blocks, ranks);
        std::vector<int> owners(colours.size());
        for (int block = 0; block < blocks.NumberOfBlocks(); ++block)
        {
          owners[block] = blocks.PlaceOf(block)[axis] >= 5;
        }
        owned.SetOwners(owners);
        int awaited = 0;
        int all = 0;
        for (int block = 0; block < blocks.NumberOfBlocks(); ++block)
        {
          if (!owned.IsOwn(block))
          {
            EXPECT_FALSE(owned.IsAwaited(block));
            continue;
          }
          ++all;
          awaited += owned.IsAwaited(block);
          for (const int other : blocks.NeighboursOf(block))
          {
            const bool isAtBorder = !owned.IsOwn(other);
            const bool comesBefore =
              owned.IsOwn(other) && owned.IsAwaited(other) && colours[block] < colours[other];
            if (isAtBorder || comesBefore)
            {
              EXPECT_TRUE(owned.IsAwaited(block)) << block << " before " << other;
            }
          }
        }
        EXPECT_GE(awaited, all / 5);
        EXPECT_LT(awaited, all) << "some come when nobody waits any more";
      });
  }
}

TEST(RankBalance, WaitsForPartnersAsLongAsTheyTake)
{
  using Turns = RankBlocks::Turns;
  // The first and the last have nothing to do with each other, but wait for the one between.
  const std::vector<Turns> ofRanks = { Turns{ { 10, 0, 5, 0, 0, 0, 0, 0 }, { 0, 1 } },
    Turns{ { 4, 6, 5, 0, 0, 0, 0, 7 }, { 0, 1, 2 } },
    Turns{ { 1, 2, 3, 4, 0, 0, 0, 0 }, { 1, 2 } } };
  using Waits = RankBlocks::WorkByColour;
  EXPECT_EQ(RankBlocks::WaitsOf(0, ofRanks), (Waits{ 0, 6, 0, 0, 4, 0, 0, 7 }));
  EXPECT_EQ(RankBlocks::WaitsOf(1, ofRanks), (Waits{ 6, 0, 0, 4, 0, 0, 0, 0 }));
  EXPECT_EQ(RankBlocks::WaitsOf(2, ofRanks), (Waits{ 3, 10, 2, 0, 0, 0, 0, 7 }));
}

TEST(RankBalance, WaitsOfASweepAreThoseOfItsAwaitedBlocks)
{
  ThreadRanks::Run(2,
    [](Communicator& ranks)
    {
      Pieces pieces(ranks);
      for (const bool onlyActive : { false, true })
      {
        std::int64_t awaited = 0;
        for (int block = 0; block < pieces.Blocks->NumberOfBlocks(); ++block)
        {
          awaited +=
            pieces.Owned->IsAwaited(block) ? pieces.Blocks->WorkOf(block, onlyActive) : 0;
        }
        const RankBlocks::WorkByColour waits = pieces.Owned->WaitsOfSweep(onlyActive);
        const auto mine = std::accumulate(waits.begin(), waits.end(), awaited);
        // In the end all have waited for who had most to do.
        for (const std::int64_t ofRank : GatherValues(ranks, mine))
        {
          EXPECT_EQ(ofRank, mine);
        }
        EXPECT_GT(mine, 0) << onlyActive;
      }
    });
}

TEST(RankBalance, HashesTellOfConnectivityAndPlaceToo)
{
  SurfaceState s;
  s.Mesh = MakeSphere({ 20., 20., 20. }, 5., 1.7);
  s.Reset(Vector(), Vector(40.f, 40.f, 40.f));
  const std::vector<std::uint64_t> before = s.HashesOf({ 0, 1, 2 });
  EXPECT_NE(before[0], before[1]);
  EXPECT_EQ(s.HashesOf({ 2, 1 }), (std::vector<std::uint64_t>{ before[2], before[1] }));
  s.Mesh.Position[0].Z += 0.5f;
  std::swap(s.Mesh.Rings[1].Item[0], s.Mesh.Rings[1].Item[1]);
  --s.Mesh.Rings[2].Count;
  const std::vector<std::uint64_t> after = s.HashesOf({ 0, 1, 2 });
  for (std::size_t v = 0; v < 3; ++v)
  {
    EXPECT_NE(after[v], before[v]) << v;
  }
}

TEST(RankBalance, RanksTellOfWhatHasChangedOnly)
{
  ThreadRanks::Run(2,
    [](Communicator& ranks)
    {
      Pieces pieces(ranks);
      SurfaceState& s = pieces.State;
      std::vector<int> own; // Blocks, and vertices that both ranks have.
      std::vector<int> border;
      for (int block = 0; block < pieces.Blocks->NumberOfBlocks(); ++block)
      {
        if (pieces.Owned->IsOwn(block))
        {
          own.push_back(block);
        }
      }
      for (int v = 0; v < s.Mesh.Size(); ++v)
      {
        if (s.Mesh.IsAlive(v) && pieces.Owned->IsOwnVertex(v))
        {
          border.push_back(v);
        }
      }
      // What is told of the vertices that `change` is called with.
      const auto told = [&](const std::function<void(const std::vector<int>&)>& change)
      {
        pieces.Owned->BeginVisits(own);
        change(border);
        pieces.Owned->EndVisits(own);
        const unsigned long long before = ranks.Sent().Bytes;
        pieces.Owned->Exchange();
        return ranks.Sent().Bytes - before;
      };
      const unsigned long long all = told(
        [&s](const std::vector<int>& vertices)
        {
          for (const int v : vertices)
          {
            s.FieldValue[v] = 3.f + static_cast<float>(v);
          }
        });
      const unsigned long long none = told([](const std::vector<int>&) {});
      const unsigned long long few = told(
        [&s](const std::vector<int>& vertices)
        {
          for (const int v : vertices)
          {
            s.RestCount[v] = v % 16 == 0 ? 7 : s.RestCount[v];
          }
        });
      EXPECT_GT(all, 20000u);
      EXPECT_LT(none, 1000u);
      EXPECT_GT(few, none);
      EXPECT_LT(few, all / 8);
      int others = 0;
      for (int v = 0; v < s.Mesh.Size(); ++v)
      {
        if (s.Mesh.IsAlive(v) && !pieces.Owned->IsOwnVertex(v))
        {
          ++others;
          EXPECT_EQ(s.FieldValue[v], 3.f + static_cast<float>(v));
          EXPECT_EQ(s.RestCount[v], v % 16 == 0 ? 7 : 0);
          EXPECT_EQ(s.Marks[v], 0);
        }
      }
      EXPECT_GT(others, 100);
    });
}
