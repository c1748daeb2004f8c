// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"
#include "Core/Image/VoxelHash.h"
#include "Core/Image/VoxelPieces.h"
#include "ThreadRanks.h"

namespace
{
using namespace volumic;

/** What a voxel is known by, wherever it is held. */
int Code(int i, int j, int k)
{
  return i + 1000 * (j + 1000 * k);
}

std::vector<int> CodesOf(const VoxelBox& box)
{
  std::vector<int> codes;
  for (int k = box.First[2]; k < box.End[2] && !box.IsEmpty(); ++k)
  {
    for (int j = box.First[1]; j < box.End[1]; ++j)
    {
      for (int i = box.First[0]; i < box.End[0]; ++i)
      {
        codes.push_back(Code(i, j, k));
      }
    }
  }
  return codes;
}

/** May be empty. */
VoxelBox RandomBox(std::mt19937& generator, int size)
{
  VoxelBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::uniform_int_distribution<int> place(0, size);
    box.First[axis] = place(generator);
    box.End[axis] = place(generator);
  }
  return box;
}

/** Slabs of an image of 20^3 voxels along z that share a layer, none for the last rank of three. */
VoxelBox SlabOf(int rank, int count)
{
  const int slabs = std::max(1, count - 1);
  if (rank >= slabs)
  {
    return {};
  }
  return { { 0, 0, rank * 20 / slabs }, { 20, 20, std::min(20, (rank + 1) * 20 / slabs + 1) } };
}

TEST(VoxelBox, IsTakenApart)
{
  std::mt19937 generator(5);
  for (int n = 0; n < 200; ++n)
  {
    const VoxelBox box = RandomBox(generator, 6);
    const VoxelBox other = RandomBox(generator, 6);
    std::vector<int> found = CodesOf(box.CommonWith(other));
    for (const VoxelBox& part : box.Without(other))
    {
      EXPECT_FALSE(part.IsEmpty());
      EXPECT_TRUE(part.CommonWith(other).IsEmpty());
      const std::vector<int> codes = CodesOf(part);
      found.insert(found.end(), codes.begin(), codes.end());
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, CodesOf(box)) << "each voxel once";
    EXPECT_EQ(box.Count(), static_cast<std::int64_t>(found.size()));
  }
}

TEST(VoxelPieces, BringEachRankTheVoxelsThatItWants)
{
  for (const int count : { 1, 2, 3, 5 })
  {
    ThreadRanks::Run(count,
      [count](Communicator& ranks)
      {
        const VoxelBox held = SlabOf(ranks.Rank(), count);
        const std::vector<int> voxels = CodesOf(held);
        VoxelPieces pieces(ranks, held);
        EXPECT_EQ(pieces.Bounds(), VoxelBox::Of({ 20, 20, 20 }));
        EXPECT_TRUE(pieces.HoldAll(VoxelBox::Of({ 20, 20, 20 })));
        pieces.BytesAtATime = 3000; // some of 1600 in a slice
        std::mt19937 generator(static_cast<unsigned int>(ranks.Rank()));
        for (int n = 0; n < 20; ++n)
        {
          const VoxelBox wanted =
            n == 0 ? VoxelBox::Of({ 20, 20, 20 }) : RandomBox(generator, 20);
          std::vector<int> fetched(static_cast<std::size_t>(wanted.Count()), -1);
          pieces.Fetch(ranks, voxels.data(), wanted, fetched.data());
          EXPECT_EQ(fetched, CodesOf(wanted));
        }
      });
  }
}

TEST(VoxelPieces, BringManyBoxesTogetherAndNothingThatIsHere)
{
  constexpr int count = 3;
  ThreadRanks::Run(count,
    [](Communicator& ranks)
    {
      const VoxelBox all = VoxelBox::Of({ 20, 20, 20 });
      const VoxelBox held = SlabOf(ranks.Rank(), count);
      const std::vector<int> voxels = CodesOf(held);
      const std::vector<int> codes = CodesOf(all);
      VoxelPieces pieces(ranks, held);
      std::vector<int> fetched(codes.size(), -1);
      const auto fetch = [&](const std::vector<VoxelBox>& wanted)
      {
        const Communicator::Traffic before = ranks.Sent();
        pieces.FetchInto(
          ranks, voxels.data(), held, sizeof(int), wanted, all, fetched.data());
        return Communicator::Traffic{ ranks.Sent().Bytes - before.Bytes,
          ranks.Sent().Messages - before.Messages };
      };
      std::vector<VoxelBox> rows; // Every other one, of rank 0.
      for (int row = 0; ranks.Rank() == 0 && row < 400; row += 2)
      {
        rows.push_back({ { 0, row % 20, row / 20 }, { 20, row % 20 + 1, row / 20 + 1 } });
      }
      EXPECT_LE(fetch(rows).Messages, 4u) << "the list of boxes, then what they hold";
      for (std::size_t i = 0; i < fetched.size(); ++i)
      {
        const bool isWanted = ranks.Rank() == 0 && i / 20 % 2 == 0;
        ASSERT_EQ(fetched[i], isWanted ? codes[i] : -1);
      }
      pieces.BytesAtATime = 3000; // Of 80 in a row.
      const std::vector<int> once = std::exchange(fetched, std::vector<int>(fetched.size(), -1));
      fetch(rows);
      EXPECT_EQ(fetched, once);
      EXPECT_LT(fetch({ held }).Bytes, 500u);
    });
}

TEST(VoxelPieces, MayLieWhereTheWholeHasRoom)
{
  ThreadRanks::Run(3,
    [](Communicator& ranks)
    {
      const VoxelBox all = VoxelBox::Of({ 20, 20, 20 });
      const VoxelBox held = SlabOf(ranks.Rank(), 3);
      const VoxelPieces pieces(ranks, held);
      const std::vector<int> codes = CodesOf(all);
      std::vector<int> voxels(codes.size(), -1);
      const auto fill = [&](const VoxelBox& box)
      {
        for (int k = box.First[2]; k < box.End[2]; ++k)
        {
          const auto first = static_cast<std::ptrdiff_t>(400) * k;
          std::copy_n(codes.begin() + first, 400, voxels.begin() + first);
        }
      };
      fill(held);
      const VoxelBox wanted = { { 3, 4, 7 }, { 18, 11, 19 } };
      pieces.FetchInto(
        ranks, voxels.data(), all, sizeof(int), { wanted }, all, voxels.data());
      for (std::size_t i = 0; i < voxels.size(); ++i)
      {
        const int n = static_cast<int>(i);
        const std::array<int, 3> place = { n % 20, n / 20 % 20, n / 400 };
        ASSERT_EQ(voxels[i], wanted.Contains(place) || held.Contains(place) ? codes[i] : -1);
      }
    });
}

TEST(VoxelHash, OfAllPartsIsThatOfTheWhole)
{
  const VoxelBox all = VoxelBox::Of({ 17, 9, 11 });
  std::mt19937 generator(8);
  StandardThreads threads(3);
  for (const std::size_t bytes : { 1, 2, 4, 8 })
  {
    SCOPED_TRACE(bytes);
    std::vector<unsigned char> voxels(static_cast<std::size_t>(all.Count()) * bytes);
    std::generate(
      voxels.begin(), voxels.end(), [&] { return static_cast<unsigned char>(generator()); });
    const auto hashOf = [&](const VoxelBox& part, Executor& executor)
    { return HashOfVoxels(voxels.data(), bytes, all, part, all, executor); };
    const std::uint64_t whole = hashOf(all, threads);
    EXPECT_EQ(hashOf(all, OnThisThread()), whole);
    EXPECT_EQ(hashOf({ { 0, 0, 0 }, { 5, 9, 11 } }, threads) +
        hashOf({ { 5, 0, 0 }, { 17, 4, 11 } }, threads) +
        hashOf({ { 5, 4, 0 }, { 17, 9, 11 } }, threads) + hashOf(VoxelBox(), threads),
      whole);
    // A part that is held alone.
    const VoxelBox slab = { { 0, 0, 4 }, { 17, 9, 7 } };
    EXPECT_EQ(HashOfVoxels(voxels.data() + static_cast<std::size_t>(all.NumberOf(0, 0, 4)) * bytes,
                bytes, slab, slab, all),
      hashOf(slab, threads));
    // Any other voxel, and any other place, makes it another.
    voxels[100 * bytes] ^= 1;
    EXPECT_NE(hashOf(all, threads), whole);
    voxels[100 * bytes] ^= 1;
    std::rotate(voxels.begin(), voxels.begin() + static_cast<std::ptrdiff_t>(bytes), voxels.end());
    EXPECT_NE(hashOf(all, threads), whole);
  }
}

TEST(VoxelPieces, LeaveVoxelsThatNobodyHolds)
{
  ThreadRanks::Run(2,
    [](Communicator& ranks)
    {
      const int first = 3 * ranks.Rank(); // slices 0 and 1, 3 and 4
      const VoxelBox held = { { 0, 0, first }, { 4, 4, first + 2 } };
      const VoxelPieces pieces(ranks, held);
      EXPECT_FALSE(pieces.HoldAll({ { 0, 0, 0 }, { 4, 4, 5 } }));
      EXPECT_TRUE(pieces.HoldAll({ { 1, 0, 0 }, { 4, 4, 2 } }));
      const std::vector<int> voxels = CodesOf(held);
      std::vector<int> fetched(4 * 4 * 5, -1);
      pieces.Fetch(ranks, voxels.data(), VoxelBox::Of({ 4, 4, 5 }), fetched.data());
      EXPECT_EQ(std::count(fetched.begin(), fetched.end(), -1), 16);
      EXPECT_EQ(std::count(fetched.begin() + 2 * 16, fetched.begin() + 3 * 16, -1), 16);
    });
}

TEST(VoxelPieces, BelongToOneRankEach)
{
  ThreadRanks::Run(4,
    [](Communicator& ranks)
    {
      const VoxelPieces pieces(ranks, SlabOf(ranks.Rank(), 4));
      std::vector<int> all;
      for (int rank = 0; rank < 4; ++rank)
      {
        for (const VoxelBox& box : pieces.OwnOf(rank))
        {
          const std::vector<int> codes = CodesOf(box);
          all.insert(all.end(), codes.begin(), codes.end());
        }
      }
      std::sort(all.begin(), all.end());
      EXPECT_EQ(all, CodesOf(VoxelBox::Of({ 20, 20, 20 })));
    });
}

TEST(VoxelPieces, AreTakenFromTheOwnMemoryFirstAndFromTheLowestRankThen)
{
  ThreadRanks::Run(3,
    [](Communicator& ranks)
    {
      // All hold slices 2 and 3, ranks 1 and 2 also slice 4.
      const int own = ranks.Rank();
      const VoxelBox held = { { 0, 0, 2 }, { 4, 4, own == 0 ? 4 : 5 } };
      const std::vector<int> voxels(static_cast<std::size_t>(held.Count()), own);
      const VoxelPieces pieces(ranks, held);
      std::vector<int> fetched(4 * 4 * 3, -1);
      pieces.Fetch(ranks, voxels.data(), { { 0, 0, 2 }, { 4, 4, 5 } }, fetched.data());
      EXPECT_EQ(std::count(fetched.begin(), fetched.begin() + 2 * 16, own), 2 * 16);
      EXPECT_EQ(std::count(fetched.begin() + 2 * 16, fetched.end(), std::max(own, 1)), 16);
    });
}
}
