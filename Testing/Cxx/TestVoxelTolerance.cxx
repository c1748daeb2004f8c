// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// VoxelTolerance and Smoothing of rough labels, measured by an independent implementation.
#include "ForVoxels.h"
#include "JudgedLabels.h"

#include <vtkImplicitPolyDataDistance.h>

using namespace volumic::support;

namespace
{
constexpr int Size = 40;

/** Return pseudo-random noise from 0 to 1. */
double NoiseAt(int i, int j, int k)
{
  auto bits = static_cast<std::uint32_t>(i + Size * (j + Size * k)) * 2654435761u;
  bits ^= bits >> 15;
  bits *= 2246822519u;
  bits ^= bits >> 13;
  return bits / 4294967296.0;
}

/** A ball with boundary noise of up to 0.6 voxels, as after thresholding. */
LabelMap RoughBall(double stretch = 1.0)
{
  LabelMap map;
  map.Size = { Size, Size, Size };
  map.Spacing = { 0.5, 0.5, 0.5 * stretch };
  volumic::ForVoxels({ Size, Size, Size },
    [&](int i, int j, int k)
    {
      const double radius = std::hypot(i - 19.3, j - 19.6, k - 19.4);
      map.Values.push_back(radius + 1.2 * NoiseAt(i, j, k) - 0.6 < 13.0 ? 1 : 0);
    });
  return map;
}

/** Counts of misclassified voxel centres, by VTK's signed distance. */
struct Misclassified
{
  int Count = 0;
  int Missed = 0; ///< further from the surface than the tolerance
};

Misclassified CountMisclassified(vtkPolyData* surface, const LabelMap& map, double tolerance)
{
  vtkNew<vtkImplicitPolyDataDistance> distance;
  distance->SetInput(surface);
  Misclassified misclassified;
  for (std::size_t v = 0; v < map.Values.size(); ++v)
  {
    const auto at = [&](std::size_t index, int axis)
    { return static_cast<double>(index) * map.Spacing[axis]; };
    const double value =
      distance->EvaluateFunction(at(v % Size, 0), at(v / Size % Size, 1), at(v / Size / Size, 2));
    if ((map.Values[v] != 0) != (value < 0.0))
    {
      ++misclassified.Count;
      misclassified.Missed += std::abs(value) > tolerance ? 1 : 0;
    }
  }
  return misclassified;
}

double DihedralOf(vtkPolyData* block)
{
  return DihedralQuantile(ToTriangleSurface(block));
}

double VolumeByVoxels(vtkPolyData* block, const LabelMap& map)
{
  return FieldOf(block, "Volume") /
    (FieldOf(block, "LabelVoxels") * map.Spacing[0] * map.Spacing[1] * map.Spacing[2]);
}
}

TEST(VoxelTolerance, SmoothsRoughLabelAndPreservesVolume)
{
  const LabelMap map = RoughBall();
  const Filter filter = FilterOf(ToImage(map));
  EXPECT_EQ(filter->GetVoxelTolerance(), -1.0) << "a quarter of Smoothing";
  filter->SetFinestLevel(-1); // for both surfaces, so that their edge lengths are equal
  filter->SetVoxelTolerance(0.0);
  const double interpolating = DihedralOf(BlockOf(filter));
  filter->SetVoxelTolerance(0.5);
  vtkPolyData* block = BlockOf(filter);
  EXPECT_LT(DihedralOf(block), 0.6 * interpolating);
  EXPECT_NEAR(VolumeByVoxels(block, map), 1.0, 0.01);
  const SurfaceVerdict verdict = JudgeSurface(ToTriangleSurface(block), FieldOf(block, "Delta"));
  EXPECT_TRUE(verdict.Topology.Closed && verdict.Topology.Manifold && verdict.Topology.Outward);
  EXPECT_EQ(verdict.Intersections.Pairs, 0u);
}

TEST(VoxelTolerance, BoundsDistanceOfMisclassifiedVoxels)
{
  for (const double stretch : { 1.0, 2.0 })
  {
    for (const double tolerance : { 0.0, 0.3, 0.6 })
    {
      SCOPED_TRACE(tolerance);
      const LabelMap map = RoughBall(stretch);
      const Filter filter = FilterOf(ToImage(map));
      filter->SetVoxelTolerance(tolerance);
      vtkPolyData* block = BlockOf(filter);
      const Misclassified misclassified =
        CountMisclassified(block, map, tolerance * map.Spacing[0]);
      EXPECT_EQ(FieldOf(block, "WrongVoxels"), misclassified.Count);
      EXPECT_EQ(FieldOf(block, "MissedVoxels"), misclassified.Missed);
      EXPECT_LT(misclassified.Missed, 0.03 * FieldOf(block, "LabelVoxels"));
      EXPECT_TRUE(tolerance == 0.0 || misclassified.Count > 2 * misclassified.Missed);
    }
  }
}

TEST(LabelSmoothing, DoesNotIncreaseRoughness)
{
  const Filter filter = FilterOf(ToImage(RoughBall()));
  for (const double tolerance : { 0.0, 0.5 })
  {
    SCOPED_TRACE(tolerance);
    filter->SetVoxelTolerance(tolerance);
    filter->SetSmoothing(1.0);
    const double little = DihedralOf(BlockOf(filter));
    for (const double smoothing : { 2.0, 3.0, 4.0 })
    {
      filter->SetSmoothing(smoothing);
      EXPECT_LT(DihedralOf(BlockOf(filter)), 1.1 * little) << smoothing;
    }
  }
}
