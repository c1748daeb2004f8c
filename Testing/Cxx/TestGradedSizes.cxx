// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/GradedSizes.h"
#include "Core/Image/Field.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "GradedTestTools.h"

using namespace volumic;

namespace
{
SequentialExecutor Alone;
constexpr double Tolerance = 0.2;

/** A plate of some voxels' thickness, turned about two axes. */
Outside OutsidePlate(double thickness)
{
  return [thickness](double x, double y, double z)
  {
    const double u = 0.8 * (x - 24.) + 0.6 * (y - 24.);
    const double v = -0.6 * (x - 24.) + 0.8 * (y - 24.);
    const double w = 0.96 * (z - 24.) + 0.28 * u;
    return OutsideBox(0.96 * u - 0.28 * (z - 24.), v, w, { 16., 15., 0.5 * thickness },
      std::min(1., 0.5 * thickness));
  };
}
}

TEST(GradedSizing, LooksFurtherThanWhereAllAreAlike)
{
  const LargeVector<float> sizes = { 1.f, 4.f };
  const SizingField even(1.f);
  EXPECT_EQ(even.Further(), 1.f);
  float before = even.Reach(0);
  for (const double gradation : { .1, .2, .3 })
  {
    SCOPED_TRACE(gradation);
    const SizingField sizing = even.Graded(sizes, 4.f, static_cast<float>(gradation));
    EXPECT_GT(sizing.Reach(0), before);
    before = sizing.Reach(0);
    // From v to a point of its star, and on to a corner of a face that grows with the distance d:
    // d = .36 longest + (1 + g d) 2.5 / sqrt 3, both in delta.
    const double longest = 1. / (1. - 1.25 * gradation); // Its delta is the mean of both ends'.
    const double furthest = (.36 * longest + 2.5 / std::sqrt(3.)) /
      (1. - gradation * 2.5 / std::sqrt(3.));
    EXPECT_GT(sizing.Reach(0), furthest);
    EXPECT_EQ(sizing.Reach(1), SizingField(4.f).Reach(1)) << "nothing is larger";
  }
  // While it evolves a part with the largest may come near to one with the least.
  const SizingField any = even.Graded(sizes, 4.f, 1.f);
  EXPECT_EQ(any.Reach(0), SizingField(4.f).Reach(0));
}

TEST(GradedSurface, GrowsBySmallStepsUpToTheLongestEdge)
{
  Grading grading = Within(2.);
  grading.MaximumEdgeLength = 5.;
  const SurfaceResult surface = SurfaceOf(OutsideBoxAndBall, grading, Alone);
  ExpectLegal(surface);
  double longest = 0.;
  double steepest = 0.;
  VisitEdges(surface,
    [&](int u, int v, double length)
    {
      longest = std::max(longest, length);
      steepest = std::max(steepest, std::abs(surface.Size[u] - surface.Size[v]) / length);
    });
  EXPECT_LE(longest, 5.);
  EXPECT_GT(longest, 4.) << "or it was not the bound";
  // Vertices have moved a little since the sizes were chosen.
  EXPECT_LT(steepest, 1.5 * grading.Gradation);
  EXPECT_FLOAT_EQ(*std::max_element(surface.Size.begin(), surface.Size.end()), 2.f);
}

TEST(GradedSurface, KeepsThinWallsWithoutHoles)
{
  for (const double thickness : { 1.5, 2.5, 4. })
  {
    SCOPED_TRACE(thickness);
    const SurfaceResult plate = SurfaceOf(OutsidePlate(thickness), Within(1.), Alone);
    ExpectLegal(plate);
    const SurfaceFeatures features = ComputeFeatures(plate);
    EXPECT_EQ(features.Components.size(), 1u);
    EXPECT_EQ(features.Genus, 0);
    // Both sides are flat and a tolerance of a voxel is much: the walls are what keeps it fine.
    const auto large = std::count_if(plate.Size.begin(), plate.Size.end(),
      [thickness](float delta) { return delta > std::max(1., 0.5 * thickness); });
    EXPECT_LT(large, 0.15 * plate.Size.size()) << "all but those at the rim";
  }
}
