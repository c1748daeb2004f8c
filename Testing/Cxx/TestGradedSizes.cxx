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
Executor Alone;
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

TEST(GradedSizing, HasALengthForEachVertexWithinBounds)
{
  const LargeVector<float> sizes = { 0.5f, 1.f, 2.f, 9.f };
  const SizingField sizing = SizingField(1.f).Graded(sizes, 4.f, 0.2f);
  EXPECT_TRUE(sizing.IsGraded());
  EXPECT_EQ(sizing.At(0), 1.f) << "no less than that of the level";
  EXPECT_EQ(sizing.At(2), 2.f);
  EXPECT_EQ(sizing.At(3), 4.f) << "no more than the most";
  EXPECT_EQ(sizing.Smallest(), 1.f);
  EXPECT_EQ(sizing.Largest(), 4.f);
  EXPECT_EQ(sizing.ShortestEdge(1, 2), 1.5f);
  EXPECT_EQ(sizing.LongestEdge(1, 2), 3.75f);
  EXPECT_EQ(sizing.InDelta(1, 2, 3.f), 2.f);
  EXPECT_EQ(sizing.Clearance(1, 3), SizingField(1.f).Clearance(0, 0)) << "that of the smaller one";
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

TEST(GradedSurface, HasFewerTrianglesWhereItIsFlatAndKeepsTheTolerance)
{
  const SurfaceResult even = SurfaceOf(OutsideBoxAndBall, Grading(), Alone);
  EXPECT_TRUE(even.Size.empty());
  const SurfaceResult graded = SurfaceOf(OutsideBoxAndBall, Within(Tolerance), Alone);
  ASSERT_EQ(graded.Size.size(), graded.Points.size());
  ExpectLegal(graded);
  EXPECT_LT(1.8 * graded.Points.size(), even.Points.size());
  EXPECT_GT(graded.FitToTolerance->WithinTolerance, 0.99);
  const SurfaceFeatures before = ComputeFeatures(even);
  const SurfaceFeatures after = ComputeFeatures(graded);
  EXPECT_EQ(after.Components.size(), before.Components.size());
  EXPECT_EQ(after.Genus, before.Genus);
  EXPECT_NEAR(after.Volume, before.Volume, 0.005 * before.Volume);
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

TEST(GradedSizes, MeasureByLookingForTheIsopotential)
{
  // All of the surface is five voxels inside a ball, where the image is flat and its slope tells
  // nothing.
  const TestVolume volume = BallVolume(48, 20.);
  const Field field(volume.Image, IsoHalf(), Alone);
  SurfaceState state;
  state.Sizing = SizingField(0.85f);
  state.Mesh.Append(DividedIcosahedron({ 24., 24., 24. }, 15., 1.4));
  state.Reset(Vector(0, 0, 0), Vector(48, 48, 48));
  std::vector<int> all(state.Mesh.Rings.size());
  std::iota(all.begin(), all.end(), 0);
  state.UpdateShape(all, Alone);
  EXPECT_NEAR(GradedSizes(state, field, Within(3.), Alone).Measure().LargestDistance, 5., 0.2);
  EXPECT_EQ(GradedSizes(state, field, Within(3.), Alone).Measure().WithinTolerance, 0.);
  EXPECT_EQ(GradedSizes(state, field, Within(0.2), Alone).Measure().LargestDistance, 2.)
    << "two units are as far as is looked then";
}

TEST(GradedSizes, AreTheLeastWhereTheFinerLevelShowsSomethingElse)
{
  const TestVolume volume = BallVolume(48, 20.);
  const Field field(volume.Image, IsoHalf(), Alone);
  Grading grading;
  grading.ThinParts = true;
  for (const double radius : { 20., 19.3 })
  {
    SCOPED_TRACE(radius);
    SurfaceState state;
    state.Sizing = SizingField(0.85f);
    state.Mesh.Append(DividedIcosahedron({ 24., 24., 24. }, radius, 1.4));
    state.Reset(Vector(0, 0, 0), Vector(48, 48, 48));
    std::vector<int> all(state.Mesh.Rings.size());
    std::iota(all.begin(), all.end(), 0);
    state.UpdateShape(all, Alone);
    GradedSizes sizes(state, field, grading, Alone);
    sizes.Begin(1.47f);
    const std::vector<int> changed = sizes.Refine();
    EXPECT_EQ(changed.size(), radius == 20. ? 0u : all.size());
    EXPECT_EQ(state.Sizing.At(0), radius == 20. ? 1.47f : 0.85f);
  }
}

TEST(GradedSizes, HaveBoundsWhateverLengthIsAskedFor)
{
  const TestVolume volume = BallVolume(16, 5.);
  const Field field(volume.Image, IsoHalf(), Alone);
  Grading grading = Within(0.2);
  // Lengths of edges; 2.5 delta are legal anywhere.
  for (const auto& [length, most] : { std::array<double, 2>{ 0., 4. }, { 0.5, 1. }, { 5., 2. },
         { 1e6, 5. }, { 1e300, 5. } })
  {
    SCOPED_TRACE(length);
    SurfaceState state;
    state.Sizing = SizingField(1.f);
    grading.MaximumEdgeLength = length;
    GradedSizes sizes(state, field, grading, Alone);
    sizes.Begin(state.Sizing.OfLevel());
    sizes.Widen();
    EXPECT_FLOAT_EQ(state.Sizing.Largest(), static_cast<float>(most));
  }
}
