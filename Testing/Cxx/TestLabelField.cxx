// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/BoundaryGaussian.h"
#include "Core/Labels/LabelHold.h"
#include "Core/Labels/LabelSides.h"
#include "LabelTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
LabelField FieldOf(
  const LabelMap& map, int object, double sigma = 2., Executor& executor = OnThisThread())
{
  LabelFieldOptions options;
  options.Sigma = sigma;
  return MakeLabelField(LabelBricks(map, executor), object, options, executor);
}

/** Voxel centres at which the field has the sign of the other side, or none. */
int CountWrongSigns(const LabelMap& map, int object, const LabelField& field)
{
  int wrong = 0;
  ForVoxelsOf(field,
    [&](int i, int j, int k, float value)
    { wrong += (map.At(i, j, k) == object) != (value > 0.f) || value == 0.f; });
  return wrong;
}
}

TEST(BoundaryGaussian, IsTheSumOfItsWeights)
{
  LabelMap map = MakeLabelMap({ 24, 24, 24 }, 1,
    [](int i, int j, int k) { return i > 7 && j > 9 && k > 11 && i < 17 ? 1 : 0; });
  const LabelBricks bricks(map, OnThisThread());
  const VoxelBits rows = LabelSides(bricks, 1).NearBoundary({ 4, 4, 4 });
  const std::array<double, 3> sigma = { 1., 1.5, 0.5 };
  std::vector<float> smooth(static_cast<std::size_t>(rows.Box().Count()));
  BoundaryGaussian().Smooth(rows, rows, sigma,
    [&](int i, int j, int k, int count, float* values)
    {
      for (int x = 0; x < count; ++x)
      {
        values[x] = map.At(i + x, j, k) == 1 ? 1.f : 0.f;
      }
    },
    [&](int i, int j, int k, int count, const float* values)
    { std::copy_n(values, count, smooth.begin() + rows.Box().NumberOf(i, j, k)); },
    OnThisThread());
  const auto along = [](double s, int n) { return std::exp(-0.5 * n * n / (s * s)); };
  int tested = 0;
  int inside = 0;
  rows.For(OnThisThread(),
    [&](int first, int j, int k, int count)
    {
      const int i = first + (5 * j + 3 * k + 100) % count;
      double sum = 0.;
      double all = 0.;
      ForBox({ -3, -5, -2 }, { 4, 6, 3 },
        [&](int a, int b, int c)
        {
          const double weight = along(1., a) * along(1.5, b) * along(0.5, c);
          all += weight;
          sum += map.At(i + a, j + b, k + c) == 1 ? weight : 0.;
        });
      ++tested;
      inside += sum > 0.2 * all;
      ASSERT_NEAR(smooth[static_cast<std::size_t>(rows.Box().NumberOf(i, j, k))], sum / all, 1e-5);
    });
  EXPECT_GT(tested, 100);
  EXPECT_GT(inside, 20);
}

TEST(LabelField, HasTheSignOfEachVoxelEvenInNoise)
{
  for (const double sigma : { 0., 0.5, 2., 6. })
  {
    const LabelMap map = NoisyLabelMap({ 17, 14, 12 }, 2, 11);
    EXPECT_EQ(CountWrongSigns(map, 1, FieldOf(map, 1, sigma)), 0) << sigma;
    EXPECT_EQ(CountWrongSigns(map, 2, FieldOf(map, 2, sigma)), 0) << sigma;
  }
}

TEST(LabelField, KeepsWhatIsAVoxelThin)
{
  const auto sheetAndThread = [](int i, int j, int k)
  { return (i == 10 && j > 3 && j < 18) || (j == 12 && k == 9 && i > 3 && i < 18) ? 1 : 0; };
  const LabelMap map = MakeLabelMap({ 22, 22, 22 }, 1, sheetAndThread);
  const LabelField field = FieldOf(map, 1);
  EXPECT_EQ(CountWrongSigns(map, 1, field), 0);
  EXPECT_GE(ValueAt(field, 10, 10, 10), 0.35f) << "far enough for triangles about it";
  EXPECT_GE(ValueAt(field, 5, 12, 9), 0.35f);
}

TEST(LabelField, IsTheDistanceToASphere)
{
  const double radius = 14.;
  const LabelMap map = BallMap(40, radius);
  const LabelField field = FieldOf(map, 1);
  double sum = 0.;
  double most = 0.;
  int count = 0;
  ForVoxelsOf(field,
    [&](int i, int j, int k, float value)
    {
      const double distance = radius - std::hypot(i - 19.6, j - 19.6, k - 19.6);
      if (std::abs(distance) < 1.)
      {
        const double off = std::abs(value - distance);
        sum += off;
        most = std::max(most, off);
        ++count;
      }
    });
  ASSERT_GT(count, 3000);
  EXPECT_LT(sum / count, 0.08);
  EXPECT_LT(most, 0.6);
}

TEST(LabelField, IsInLengthsOfTheWorldWhereVoxelsAreLong)
{
  LabelMap map = MakeLabelMap({ 48, 48, 16 }, 1,
    [](int i, int j, int k)
    { return std::hypot(i - 23.4, j - 23.7, 3. * (k - 7.6)) < 15. ? 1 : 0; });
  map.Spacing = { 1., 1., 3. };
  const LabelField field = FieldOf(map, 1, 6.);
  double sum = 0.;
  int count = 0;
  ForVoxelsOf(field,
    [&](int i, int j, int k, float value)
    {
      const double distance = 15. - std::hypot(i - 23.4, j - 23.7, 3. * (k - 7.6));
      if (std::abs(distance) < 1.)
      {
        sum += std::abs(value - distance);
        ++count;
      }
    });
  ASSERT_GT(count, 500);
  EXPECT_LT(sum / count, 0.21);
  EXPECT_EQ(CountWrongSigns(map, 1, field), 0);
}

TEST(LabelField, ReachesBeyondTheMapWhereTheObjectDoes)
{
  const LabelMap map = MakeLabelMap({ 28, 28, 28 }, 1, [](int, int, int) { return 1; });
  const LabelField field = FieldOf(map, 1);
  EXPECT_LE(field.Box.First[0], -4);
  EXPECT_GE(field.Box.End[0], 32);
  EXPECT_GT(ValueAt(field, 0, 14, 14), 0.f);
  EXPECT_LT(ValueAt(field, -1, 14, 14), 0.f);
  // The boundary is where voxels end.
  EXPECT_NEAR(ValueAt(field, 0, 14, 14), -ValueAt(field, -1, 14, 14), 0.05);
}

TEST(LabelField, IsTheSameBitsOnAnyThreads)
{
  const LabelMap map = NoisyLabelMap({ 33, 30, 29 }, 3, 2);
  const LabelField alone = FieldOf(map, 2);
  DelayedThreads threads(4, 1, 50, 3);
  EXPECT_EQ(FieldOf(map, 2, 2., threads).Values, alone.Values);
}

TEST(VoxelBox, PartsAreTheWhole)
{
  const VoxelBox box{ { -3, 5, 0 }, { 20, 11, 17 } };
  std::set<std::array<int, 3>> found;
  for (const VoxelBox& part : box.Parts(8))
  {
    EXPECT_LE(std::max({ part.Length(0), part.Length(1), part.Length(2) }), 8);
    ForBox(part.First, part.End,
      [&](int i, int j, int k)
      {
        EXPECT_TRUE(box.Contains({ i, j, k }));
        EXPECT_TRUE(found.insert({ i, j, k }).second);
      });
  }
  EXPECT_EQ(static_cast<std::int64_t>(found.size()), box.Count());
}

TEST(HoldToLabels, MeetsItsConstraintsAndLeavesTheRest)
{
  LabelField field;
  field.Box = { { 0, 0, 0 }, { 30, 30, 30 } };
  field.Values.assign(27000, 0.f);
  ForVoxelsOf(field,
    [&](int i, int j, int k, float)
    { field.Values[static_cast<std::size_t>(field.Box.NumberOf(i, j, k))] = 15.2f - i; });
  const LabelField before = field;
  std::vector<VoxelConstraint> constraints;
  for (int n = 0; n < 20; ++n)
  {
    constraints.push_back(
      { field.Box.NumberOf(14 + n % 3, 10 + n % 7, 8 + n % 11), n % 2 == 0 ? 1.f : -1.f, 0.2f });
  }
  HoldToLabels(field, { 1., 1., 1. }, constraints);
  for (const VoxelConstraint& constraint : constraints)
  {
    EXPECT_GE(constraint.Side * field.Values[static_cast<std::size_t>(constraint.Place)], 0.18f);
  }
  EXPECT_EQ(ValueAt(field, 14, 24, 8), ValueAt(before, 14, 24, 8)) << "far from all of them";
  // What is met already changes nothing.
  LabelField again = before;
  HoldToLabels(again, { 1., 1., 1. }, { { field.Box.NumberOf(3, 3, 3), 1.f, 0.2f } });
  EXPECT_EQ(again.Values, before.Values);
}

namespace
{
/** Where between the centres of a voxel inside and one outside the field is 0. */
double CrossingOf(float inside, float outside)
{
  return inside / (static_cast<double>(inside) - outside);
}
}

TEST(LabelFieldOfThinParts, RodsAndVoxelsKeepTheirWidth)
{
  const LabelMap rod = MakeLabelMap({ 32, 24, 24 }, 1,
    [](int i, int j, int k) { return i > 5 && i < 26 && j == 12 && k == 12 ? 1 : 0; });
  const LabelField field = FieldOf(rod, 1);
  const LabelMap voxel = MakeLabelMap(
    { 24, 24, 24 }, 1, [](int i, int j, int k) { return i == 12 && j == 12 && k == 12 ? 1 : 0; });
  const LabelField small = FieldOf(voxel, 1);
  const float middle = ValueAt(field, 16, 12, 12);
  for (const int side : { -1, 1 })
  {
    EXPECT_NEAR(CrossingOf(middle, ValueAt(field, 16, 12 + side, 12)), 0.5, 0.12);
    EXPECT_NEAR(CrossingOf(middle, ValueAt(field, 16, 12, 12 + side)), 0.5, 0.12);
    EXPECT_NEAR(
      CrossingOf(ValueAt(small, 12, 12, 12), ValueAt(small, 12 + side, 12, 12)), 0.6, 0.12);
  }
}

TEST(LabelFieldWithTolerance, HasBumpsAndPitsWrongByThatButLosesNothingThin)
{
  // A slab with a bump, a pit, and a rod that stands on it.
  const LabelMap map = MakeLabelMap({ 40, 40, 24 }, 2,
    [](int i, int j, int k)
    {
      const bool isBump = i == 8 && j == 8 && k == 12;
      const bool isPit = i == 20 && j == 8 && k == 11;
      const bool isRod = i == 20 && j == 28 && k < 20;
      return (k >= 5 && k < 12 && !isPit) || isBump || isRod ? 1 : 2;
    });
  LabelFieldOptions options;
  options.Tolerance = 0.5;
  const LabelBricks bricks(map, OnThisThread());
  const LabelField field = MakeLabelField(bricks, 1, options, OnThisThread());
  EXPECT_LT(ValueAt(field, 8, 8, 12), 0.f);
  EXPECT_GE(ValueAt(field, 8, 8, 12), -0.5f);
  EXPECT_GT(ValueAt(field, 20, 8, 11), 0.f);
  EXPECT_LE(ValueAt(field, 20, 8, 11), 0.5f);
  EXPECT_GT(ValueAt(field, 20, 28, 18), 0.3f);
  const LabelField others = MakeLabelField(bricks, 2, options, OnThisThread());
  EXPECT_NEAR(ValueAt(others, 8, 8, 12), -ValueAt(field, 8, 8, 12), 0.02);
  EXPECT_NEAR(ValueAt(others, 20, 8, 11), -ValueAt(field, 20, 8, 11), 0.02);
}

TEST(LabelFieldWithTolerance, DoesNotThickenPlates)
{
  const LabelMap map =
    MakeLabelMap({ 32, 32, 32 }, 1, [](int, int, int k) { return k >= 14 && k < 17 ? 1 : 0; });
  LabelFieldOptions options;
  options.Tolerance = 0.5;
  const LabelField field =
    MakeLabelField(LabelBricks(map, OnThisThread()), 1, options, OnThisThread());
  EXPECT_NEAR(CrossingOf(ValueAt(field, 16, 16, 16), ValueAt(field, 16, 16, 17)), 0.5, 0.15);
}

TEST(LabelFieldOfThinParts, SlitsKeepTheirsToo)
{
  const auto isRod = [](int i, int j, int k)
  { return i > 5 && i < 26 && (j == 12 || j == 13) && k == 12; };
  const LabelMap map =
    MakeLabelMap({ 32, 26, 24 }, 2, [&](int i, int j, int k) { return isRod(i, j, k) ? 1 : 2; });
  const LabelField rod = FieldOf(map, 1);
  const LabelField others = FieldOf(map, 2);
  EXPECT_EQ(CountWrongSigns(map, 1, rod), 0);
  EXPECT_EQ(CountWrongSigns(map, 2, others), 0);
  for (int j = 9; j < 17; ++j)
  {
    for (int k = 9; k < 16; ++k)
    {
      EXPECT_NEAR(ValueAt(rod, 16, j, k), -ValueAt(others, 16, j, k), 0.05) << j << ", " << k;
    }
  }
}

TEST(LabelFieldOfThinParts, KeepTheirThicknessWithMuchSmoothing)
{
  const LabelMap map =
    MakeLabelMap({ 32, 32, 32 }, 1, [](int, int, int k) { return k == 15 || k == 16 ? 1 : 0; });
  const LabelField field = FieldOf(map, 1, 4.);
  EXPECT_EQ(CountWrongSigns(map, 1, field), 0);
  EXPECT_NEAR(CrossingOf(ValueAt(field, 16, 16, 16), ValueAt(field, 16, 16, 17)), 0.5, 0.3);
}
