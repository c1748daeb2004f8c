// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Blocks that go from rank to rank, until all have as much to do.
#include "Core/Evolution/MeshPiece.h"
#include "RankBlocksTestTools.h"

using namespace volumic;

namespace
{
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
