// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What ranks tell each other in a sweep, in which order, and how long they wait for it.
#include "RankBlocksTestTools.h"

TEST(RankExchange, VisitsFirstWhatOthersWaitFor)
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

TEST(RankExchange, WaitsForPartnersAsLongAsTheyTake)
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

TEST(RankExchange, WaitsOfASweepAreThoseOfItsAwaitedBlocks)
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

TEST(RankExchange, HashesTellOfConnectivityAndPlaceToo)
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

TEST(RankExchange, RanksTellOfWhatHasChangedOnly)
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
