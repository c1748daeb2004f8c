// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces of labels that touch, by the judge that shares no code with the filter.
#include "JudgedLabels.h"

using namespace volumic::support;

TEST(LabelNeighbours, HardlyOverlap)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::CutBall, 64);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  double sum = 0.0, count = 0.0;
  for (unsigned int a = 0; a < 4; ++a)
  {
    for (unsigned int b = a + 1; b < 4; ++b)
    {
      const OverlapVerdict verdict = JudgeOverlap(
        ToTriangleSurface(BlockOf(filter, a)), ToTriangleSurface(BlockOf(filter, b)));
      sum += verdict.MeanDepth * static_cast<double>(verdict.VerticesInside);
      count += static_cast<double>(verdict.VerticesInside);
    }
  }
  ASSERT_GT(count, 100.0); // they are in contact
  EXPECT_LT(sum / count, 0.05);
}

TEST(LabelNeighbours, AreApartWithAGap)
{
  DigitisedShapes shapes = Digitise(LabelShapeKind::CutBall, 64);
  shapes.Map.Spacing = { 0.4, 0.4, 0.4 }; // Gap is one of world units
  const Filter filter = FilterOf(ToImage(shapes.Map));
  filter->SetGap(0.3 * 0.4);
  for (unsigned int a = 0; a < 4; ++a)
  {
    ExpectGoodTriangles(BlockOf(filter, a));
    for (unsigned int b = a + 1; b < 4; ++b)
    {
      const OverlapVerdict verdict = JudgeOverlap(
        ToTriangleSurface(BlockOf(filter, a)), ToTriangleSurface(BlockOf(filter, b)));
      EXPECT_EQ(verdict.VerticesInside, 0u) << a << " and " << b;
      EXPECT_EQ(verdict.IntersectingPairs, 0u) << a << " and " << b;
    }
  }
}

TEST(LabelNeighbours, AreDrawnBackByHalfTheGap)
{
  DigitisedShapes shapes = Digitise(LabelShapeKind::Sphere, 64);
  shapes.Map.Spacing = { 0.4, 0.4, 0.4 };
  const Filter filter = FilterOf(ToImage(shapes.Map));
  const double before = FieldOf(BlockOf(filter), "Volume");
  filter->SetGap(0.4);
  EXPECT_NEAR(FieldOf(BlockOf(filter), "Volume") / before, std::pow(19.5 / 20.0, 3.0), 0.004);
}

namespace
{
/** Some blobs of labels in each other, by chance, but always the same. */
LabelMap RandomBlobs(int size, int labels, unsigned seed)
{
  const auto next = [&seed](double high)
  {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0 * high;
  };
  LabelMap map;
  map.Size = { size, size, size };
  map.Values.assign(static_cast<std::size_t>(size) * size * size, 0);
  for (int blob = 0; blob < 3 * labels; ++blob)
  {
    const double centre[3] = { next(size), next(size), next(size) };
    const double radius[3] = { 2.0 + next(6.0), 2.0 + next(6.0), 2.0 + next(6.0) };
    for (std::size_t v = 0; v < map.Values.size(); ++v)
    {
      const int n = static_cast<int>(v);
      const int place[3] = { n % size, n / size % size, n / size / size };
      double square = 0.0;
      for (int a = 0; a < 3; ++a)
      {
        square += std::pow((place[a] - centre[a]) / radius[a], 2.0);
      }
      if (square < 1.0)
      {
        map.Values[v] = static_cast<std::int16_t>(1 + blob % labels);
      }
    }
  }
  return map;
}
} // namespace

class LabelGaps : public testing::TestWithParam<double>
{
};

// Triangles cut corners that fields do not have in common: an exact test between neighbours tells.
TEST_P(LabelGaps, OfAnySizeKeepNeighboursApart)
{
  for (const int level : { 0, 1 })
  {
    for (unsigned seed = 1; seed <= 4; ++seed)
    {
      const Filter filter = FilterOf(ToImage(RandomBlobs(28, 5, seed)));
      filter->SetGap(GetParam());
      filter->SetFinestLevel(level);
      filter->Update();
      for (unsigned int a = 0; a < 5; ++a)
      {
        for (unsigned int b = a + 1; b < 5; ++b)
        {
          EXPECT_EQ(JudgeOverlap(ToTriangleSurface(BlockOf(filter, a)),
                      ToTriangleSurface(BlockOf(filter, b))).IntersectingPairs,
            0u)
            << "level " << level << ", seed " << seed << ", blocks " << a << ", " << b;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, LabelGaps, testing::Values(0.05, 0.5),
  [](const testing::TestParamInfo<double>& info)
  { return std::to_string(static_cast<int>(std::round(100.0 * info.param))) + "Percent"; });
