// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/AxisOperator.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/PieceReduction.h"
#include "Core/Image/ValidReduction.h"
#include "ForVoxels.h"
#include "ThreadRanks.h"

#include <type_traits>

using namespace volumic;

namespace
{
const LevelProgress GoOn = [](double) { return true; };

/** Hands out ranges as scheduling might: short ones, last first. */
class ScrambledExecutor : public Executor
{
public:
  explicit ScrambledExecutor(std::size_t chunk) : Chunk(chunk) {}
  void For(
    std::size_t n, std::size_t, const std::function<void(std::size_t, std::size_t)>& body) override
  {
    for (std::size_t end = n; end > 0;)
    {
      const std::size_t begin = end > this->Chunk ? end - this->Chunk : 0;
      body(begin, end);
      end = begin;
    }
  }

private:
  std::size_t Chunk;
};

template <typename T>
std::vector<T> RandomVoxels(std::int64_t n)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<T> voxels(n);
  for (T& voxel : voxels)
  {
    voxel = static_cast<T>(share(generator) * 120.0);
  }
  return voxels;
}

template <typename T>
std::vector<typename RealOf<T>::Type> Reduce(
  const std::vector<T>& voxels, const std::vector<LevelGeometry>& levels, Executor& executor)
{
  std::vector<typename RealOf<T>::Type> out(levels[1].NumberOfVoxels(), -1);
  EXPECT_TRUE(ReduceLevel(voxels.data(), levels[0], out.data(), levels[1], executor, GoOn));
  return out;
}

std::vector<LevelGeometry> TwoLevels(
  const LevelSize& size, const std::array<double, 3>& spacing = { 1, 1, 1 })
{
  PyramidOptions options;
  options.NumberOfLevels = 2;
  return PlanPyramid(size, spacing, options);
}
}

TEST(LevelReduction, IsTheSameBitsForAnyChunks)
{
  // Long enough along y for several tiles; sizes that no vector length divides.
  const auto levels = TwoLevels({ 61, 203, 23 }, { 1, 1, 2.5 });
  const auto voxels = RandomVoxels<float>(levels[0].NumberOfVoxels());
  SequentialExecutor sequential;
  const auto expected = Reduce(voxels, levels, sequential);
  for (const std::size_t chunk : { 1, 3, 7 })
  {
    ScrambledExecutor scrambled(chunk);
    const auto found = Reduce(voxels, levels, scrambled);
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size() * sizeof(expected[0])), 0)
      << "chunks of " << chunk;
  }
}

TEST(LevelReduction, IsTheProductOfTheOperatorsAlongTheAxes)
{
  // Voxels of three different lengths: the offset of the kernel is U_0 = 1 along each axis, which
  // is less than a voxel where voxels are longer.
  const auto levels = TwoLevels({ 13, 11, 9 }, { 1, 1.3, 2.5 });
  const auto voxels = RandomVoxels<double>(levels[0].NumberOfVoxels());
  SequentialExecutor executor;
  const auto found = Reduce(voxels, levels, executor);
  const LevelSize& in = levels[0].Size;
  const LevelSize& out = levels[1].Size;
  const AxisOperator x(in[0], out[0], 1.);
  const AxisOperator y(in[1], out[1], 1. / 1.3);
  const AxisOperator z(in[2], out[2], 1. / 2.5);
  for (std::int64_t i = 0; i < levels[1].NumberOfVoxels(); ++i)
  {
    const std::int64_t place[3] = { i % out[0], i / out[0] % out[1], i / out[0] / out[1] };
    double sum = 0;
    ForVoxels({ x.NumberOfTaps(), y.NumberOfTaps(), z.NumberOfTaps() },
      [&](int a, int b, int c)
      {
        const std::int64_t voxel = x.First(place[0]) + a +
          in[0] * (y.First(place[1]) + b + in[1] * (z.First(place[2]) + c));
        sum += x.Weights(place[0])[a] * y.Weights(place[1])[b] * z.Weights(place[2])[c] *
          voxels[voxel];
      });
    EXPECT_NEAR(found[i], sum, 1e-10) << "voxel " << i;
  }
}

namespace
{
/** The voxels of a box. */
template <typename T>
std::vector<T> VoxelsIn(const VoxelBox& box, const std::vector<T>& voxels, const VoxelBox& all)
{
  std::vector<T> part;
  ForRowsOf(box, all,
    [&](std::int64_t first, std::int64_t count)
    { part.insert(part.end(), voxels.begin() + first, voxels.begin() + first + count); });
  return part;
}

/** NaN is not equal to itself. */
std::vector<std::uint32_t> BitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits(values.size());
  if (!values.empty()) // The data of none may be null, which memcpy does not take.
  {
    std::memcpy(bits.data(), values.data(), values.size() * sizeof(float));
  }
  return bits;
}

/** Boxes at the borders, in the middle, of one voxel, and of all. */
std::vector<VoxelBox> BoxesOf(const VoxelBox& all)
{
  const auto [x, y, z] = all.End;
  return { all, { { 0, 0, 0 }, { 1, 1, 1 } }, { { x - 1, y - 1, z - 1 }, { x, y, z } },
    { { 3, y / 3, 1 }, { x - 2, y / 2, z - 1 } }, { { 0, y / 2, z / 2 }, { x / 2, y, z } },
    { { x / 2, 0, 0 }, { x, y / 2, z / 2 } } };
}
}

TEST(LevelReduction, GivesPartsOfALevelTheSameBits)
{
  const auto levels = TwoLevels({ 61, 203, 23 }, { 1, 1, 2.5 });
  const auto voxels = RandomVoxels<float>(levels[0].NumberOfVoxels());
  const VoxelBox all = LevelPiece::VoxelsOf(levels[0]);
  SequentialExecutor executor;
  const auto whole = Reduce(voxels, levels, executor);
  for (const VoxelBox& box : BoxesOf(LevelPiece::VoxelsOf(levels[1])))
  {
    const VoxelBox source = SourceOf(box, levels[0], levels[1]);
    EXPECT_EQ(source.CommonWith(all), source);
    const auto input = VoxelsIn(source, voxels, all);
    std::vector<float> part(box.Count());
    EXPECT_TRUE(ReduceLevel(input.data(), LevelPiece(levels[0], source), part.data(),
      LevelPiece(levels[1], box), executor, GoOn));
    EXPECT_EQ(part, VoxelsIn(box, whole, LevelPiece::VoxelsOf(levels[1])));
  }
}

TEST(ValidReduction, GivesPartsOfALevelTheSameBits)
{
  const auto levels = TwoLevels({ 30, 41, 22 });
  const auto voxels = RandomVoxels<float>(levels[0].NumberOfVoxels());
  std::vector<std::uint8_t> marks(voxels.size(), 1);
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    marks[i] = i % 7 == 0 || i < marks.size() / 3 ? 0 : 1;
  }
  const auto reduce = [&](const VoxelBox& source, const VoxelBox& box)
  {
    const VoxelBox all = LevelPiece::VoxelsOf(levels[0]);
    const auto input = VoxelsIn(source, voxels, all);
    const auto part = VoxelsIn(source, marks, all);
    const LargeVector<std::uint8_t> valid(part.begin(), part.end());
    std::vector<float> made(box.Count());
    SequentialExecutor executor;
    EXPECT_TRUE(ReduceValidVoxels(input.data(), valid, LevelPiece(levels[0], source), made.data(),
      LevelPiece(levels[1], box), executor, GoOn));
    return BitsOf(made);
  };
  const VoxelBox all = LevelPiece::VoxelsOf(levels[1]);
  const auto whole = reduce(LevelPiece::VoxelsOf(levels[0]), all);
  for (const VoxelBox& box : BoxesOf(all))
  {
    EXPECT_EQ(reduce(SourceOf(box, levels[0], levels[1]), box), VoxelsIn(box, whole, all));
  }
}

namespace
{
/** Cut along y and z; from five ranks on the last has nothing. */
VoxelBox PieceOf(const VoxelBox& all, int rank, int count)
{
  const int parts = count < 5 ? count : count - 1;
  VoxelBox piece = all;
  const int axis = count < 4 ? 2 : 1;
  const int z = count < 4 ? 0 : rank % 2;
  const int n = count < 4 ? rank : rank / 2;
  const int along = count < 4 ? parts : parts / 2;
  piece.First[axis] = all.End[axis] * n / along;
  piece.End[axis] = std::min(all.End[axis], all.End[axis] * (n + 1) / along + 1);
  if (count >= 4)
  {
    piece.First[2] = z * all.End[2] / 2;
    piece.End[2] = z == 0 ? all.End[2] / 2 + 1 : all.End[2];
  }
  return rank < parts ? piece : VoxelBox();
}
}

TEST(PieceReduction, GivesRanksTheBitsOfTheWholeLevel)
{
  const auto levels = TwoLevels({ 40, 57, 33 });
  const auto voxels = RandomVoxels<short>(levels[0].NumberOfVoxels());
  std::vector<std::uint8_t> marks(voxels.size());
  std::transform(voxels.begin(), voxels.end(), marks.begin(),
    [](short voxel) { return static_cast<std::uint8_t>(voxel % 3 != 0); });
  const VoxelBox below = LevelPiece::VoxelsOf(levels[0]);
  const VoxelBox above = LevelPiece::VoxelsOf(levels[1]);
  SequentialExecutor executor;
  const auto whole = Reduce(voxels, levels, executor);
  std::vector<float> valid(whole.size());
  ReduceValidVoxels(voxels.data(), LargeVector<std::uint8_t>(marks.begin(), marks.end()),
    levels[0], valid.data(), levels[1], executor, GoOn);
  for (const int count : { 1, 2, 3, 4, 5 })
  {
    ThreadRanks::Run(count,
      [&](Communicator& ranks)
      {
        const VoxelBox held = PieceOf(below, ranks.Rank(), count);
        const auto values = VoxelsIn(held, voxels, below);
        const auto heldMarks = VoxelsIn(held, marks, below);
        const VoxelPieces pieces(ranks, held);
        // The pieces above are not where those below are.
        const VoxelBox box = PieceOf(above, (ranks.Rank() + 1) % count, count);
        std::vector<float> made(static_cast<std::size_t>(box.Count()));
        SequentialExecutor thread;
        for (const bool haveAll : { true, false })
        {
          const MarkedVoxels<short> own = { values.data(), heldMarks.data(), haveAll };
          // So few bytes that each rank makes several slabs.
          EXPECT_TRUE(ReducePieces(ranks, pieces, own, levels[0], made.data(),
            LevelPiece(levels[1], box), thread, GoOn, 50000));
          EXPECT_EQ(BitsOf(made), BitsOf(VoxelsIn(box, haveAll ? whole : valid, above)))
            << count << " ranks";
        }
      });
  }
}

TEST(PieceReduction, StopsOnAllRanksWhenOneIsAskedTo)
{
  const auto levels = TwoLevels({ 20, 20, 40 });
  ThreadRanks::Run(3,
    [&](Communicator& ranks)
    {
      const VoxelBox held = PieceOf(LevelPiece::VoxelsOf(levels[0]), ranks.Rank(), 3);
      const std::vector<float> values(static_cast<std::size_t>(held.Count()), 1.f);
      const VoxelBox box = PieceOf(LevelPiece::VoxelsOf(levels[1]), ranks.Rank(), 3);
      std::vector<float> made(static_cast<std::size_t>(box.Count()));
      MarkedVoxels<float> own;
      own.Values = values.data();
      int reports = 0;
      const auto stopOnOne = [&](double) { return ++reports < 2 || ranks.Rank() != 1; };
      SequentialExecutor thread;
      EXPECT_FALSE(ReducePieces(ranks, VoxelPieces(ranks, held), own, levels[0], made.data(),
        LevelPiece(levels[1], box), thread, stopOnOne, 1000));
      EXPECT_EQ(reports, 2);
    });
}

template <typename T>
class LevelReductionOf : public ::testing::Test
{
};
using Scalars = ::testing::Types<char, signed char, unsigned char, short, unsigned short, int,
  unsigned int, long, unsigned long, long long, unsigned long long, float, double>;
TYPED_TEST_SUITE(LevelReductionOf, Scalars, ); // C++17 wants the comma

TYPED_TEST(LevelReductionOf, GivesWhatDoublesGiveWhateverAVectorLengthLeaves)
{
  using Real = typename RealOf<TypeParam>::Type;
  const bool isDouble = std::is_same<TypeParam, double>::value;
  EXPECT_EQ((std::is_same<Real, double>::value), isDouble);
  SequentialExecutor executor;
  for (std::int64_t width = 1; width <= 40; ++width)
  {
    const auto levels = TwoLevels({ width, 11, 5 }, { 1, 1.3, 2.5 });
    const auto voxels = RandomVoxels<TypeParam>(levels[0].NumberOfVoxels());
    const auto found = Reduce(voxels, levels, executor);
    const auto expected =
      Reduce(std::vector<double>(voxels.begin(), voxels.end()), levels, executor);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      ASSERT_NEAR(found[i], expected[i], isDouble ? 0.0 : 1e-4)
        << "width " << width << ", voxel " << i;
    }
  }
}

TEST(LevelReduction, StopsWhenAsked)
{
  // Large enough for several reports: one per few million voxels.
  const auto levels = TwoLevels({ 256, 256, 200 });
  const std::vector<unsigned char> voxels(levels[0].NumberOfVoxels(), 1);
  std::vector<float> out(levels[1].NumberOfVoxels(), -1.f);
  SequentialExecutor executor;
  int reports = 0;
  const auto stop = [&](double share)
  {
    EXPECT_LT(share, 1.0);
    ++reports;
    return false;
  };
  EXPECT_FALSE(ReduceLevel(voxels.data(), levels[0], out.data(), levels[1], executor, stop));
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(out.back(), -1.f) << "the rest is not computed after a stop";
}

TEST(FindNotFiniteVoxels, CountsAndFindsTheFirst)
{
  std::vector<float> voxels(300000, 1.f);
  SequentialExecutor executor;
  EXPECT_EQ(FindNotFiniteVoxels(voxels.data(), 300000, executor).Count, 0);
  EXPECT_EQ(FindNotFiniteVoxels(voxels.data(), 300000, executor).First, -1);
  voxels[299999] = std::numeric_limits<float>::quiet_NaN();
  voxels[70001] = -std::numeric_limits<float>::infinity();
  voxels[70007] = std::numeric_limits<float>::infinity();
  ScrambledExecutor scrambled(2);
  for (Executor* e : { static_cast<Executor*>(&executor), static_cast<Executor*>(&scrambled) })
  {
    const NotFiniteVoxels found = FindNotFiniteVoxels(voxels.data(), 300000, *e);
    EXPECT_EQ(found.Count, 3);
    EXPECT_EQ(found.First, 70001);
  }
}

TEST(ValidReduction, IsTheMeanOfTheVoxelsWithAValue)
{
  const auto levels = TwoLevels({ 30, 20, 24 });
  SequentialExecutor executor;
  // Some have none: the mean of the others is theirs, whatever stands at these places.
  LargeVector<std::uint8_t> valid(levels[0].NumberOfVoxels());
  std::vector<short> voxels(valid.size());
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    valid[i] = i % 7 == 0 ? 0 : 1;
    voxels[i] = i % 7 == 0 ? -9999 : 40;
  }
  std::vector<float> out(levels[1].NumberOfVoxels());
  std::vector<double> shares;
  EXPECT_TRUE(ReduceValidVoxels(voxels.data(), valid, levels[0], out.data(), levels[1], executor,
    [&](double share)
    {
      shares.push_back(share);
      return true;
    }));
  for (const float value : out)
  {
    ASSERT_NEAR(value, 40.f, 1e-4f);
  }
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_EQ(MarkNumbers(out.data(), 3), LargeVector<std::uint8_t>(3, 1));
}

TEST(ValidReduction, HasNoValueWhereHalfOfTheWeightHasNone)
{
  const auto levels = TwoLevels({ 30, 20, 24 });
  SequentialExecutor executor;
  LargeVector<std::uint8_t> valid(levels[0].NumberOfVoxels());
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    valid[i] = i % 30 < 15 ? 1 : 0;
  }
  const std::vector<double> voxels(valid.size(), 1e9 + 7.0);
  std::vector<double> out(levels[1].NumberOfVoxels());
  EXPECT_TRUE(ReduceValidVoxels(
    voxels.data(), valid, levels[0], out.data(), levels[1], executor, GoOn));
  const auto size = levels[1].Size;
  for (std::int64_t i = 0; i < levels[1].NumberOfVoxels(); ++i)
  {
    // Voxels of level 0 end at 14; half of the kernel lies beyond 14.5.
    const double place = static_cast<double>(i % size[0]) * 30.0 / static_cast<double>(size[0]);
    ASSERT_EQ(std::isnan(out[i]), place > 14.5) << place;
    ASSERT_TRUE(std::isnan(out[i]) || std::abs(out[i] - 1e9 - 7.0) < 1e-5);
  }
  EXPECT_EQ(MarkNumbers(out.data(), 1)[0], 1);
  EXPECT_EQ(MarkNumbers(&out[size[0] - 1], 1)[0], 0);
}
