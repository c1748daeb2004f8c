// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surfaces of labels enclose the volume of their voxels for any slice spacing, thickness and
// smoothing, and are accurate for analytic shapes. An independent implementation measures both.
#include "ForVoxels.h"
#include "JudgedLabels.h"

#include <cmath>
#include <functional>
#include <string>

using namespace volumic::support;

namespace
{
/** Whether a point is inside, in world coordinates relative to the middle. */
using Inside = std::function<bool(double x, double y, double z)>;

struct VolumeScene
{
  std::string Name;
  std::array<double, 3> Spacing;
  std::array<double, 3> HalfSize; ///< world units
  Inside IsInside;
};

LabelMap MapOf(const VolumeScene& scene)
{
  constexpr int margin = 4;
  // The middle is not at a voxel centre and not halfway between two.
  constexpr std::array<double, 3> offset = { 0.13, 0.27, 0.31 };
  LabelMap map;
  map.Spacing = scene.Spacing;
  std::array<int, 3> half;
  for (int axis = 0; axis < 3; ++axis)
  {
    half[axis] = static_cast<int>(std::ceil(scene.HalfSize[axis] / scene.Spacing[axis])) + margin;
    map.Size[axis] = 2 * half[axis] + 1;
  }
  volumic::ForBox({ -half[0], -half[1], -half[2] }, { half[0] + 1, half[1] + 1, half[2] + 1 },
    [&](int i, int j, int k)
    {
      const bool isInside = scene.IsInside((i + offset[0]) * map.Spacing[0],
        (j + offset[1]) * map.Spacing[1], (k + offset[2]) * map.Spacing[2]);
      map.Values.push_back(isInside ? 1 : 0);
    });
  return map;
}

Inside Ball(double radius)
{
  return [=](double x, double y, double z) { return std::hypot(x, y, z) < radius; };
}

Inside Skin(double radius, double thickness)
{
  return [=](double x, double y, double z)
  { return std::abs(std::hypot(x, y, z) - radius + thickness / 2.0) < thickness / 2.0; };
}

Inside Wall(double radius, double thickness, double halfLength)
{
  return [=](double x, double y, double z)
  {
    return std::abs(z) < halfLength &&
      std::abs(std::hypot(x, y) - radius + thickness / 2.0) < thickness / 2.0;
  };
}

/** An arc of thickness 6 that rises along x. */
bool IsInRib(double x, double y, double z)
{
  return y > 0.0 && std::abs(std::hypot(x, y) - 32.0) < 3.0 && std::abs(z - 0.3 * x) < 5.0;
}

class LabelVolumes : public testing::TestWithParam<VolumeScene>
{
};

/** Upper bounds of the errors. Lengths are in the smallest voxel spacing. */
struct AccuracyBounds
{
  const char* Name;
  LabelShapeKind Kind;
  int Size;
  double Stretch;
  double Distance;    ///< mean distance of vertices and centroids
  double Angle;       ///< mean angle of normals in degrees
  double VolumeError; ///< relative
  double Wrong;       ///< fraction of misclassified voxels
};

class LabelAccuracy : public testing::TestWithParam<AccuracyBounds>
{
};
}

TEST_P(LabelVolumes, EqualVoxelVolumesForAllSmoothings)
{
  const LabelMap map = MapOf(this->GetParam());
  struct Settings
  {
    double Smoothing;
    double VoxelTolerance; ///< -1: a quarter of Smoothing
  };
  for (const Settings& set : { Settings{ 2.0, -1.0 }, { 1.0, -1.0 }, { 8.0, -1.0 }, { 2.0, 0.0 } })
  {
    SCOPED_TRACE(testing::Message() << set.Smoothing << ", " << set.VoxelTolerance);
    const Filter filter = FilterOf(ToImage(map));
    filter->SetSmoothing(set.Smoothing);
    filter->SetVoxelTolerance(set.VoxelTolerance);
    vtkPolyData* block = BlockOf(filter);
    const TriangleSurface surface = ToTriangleSurface(block);
    EXPECT_EQ(JudgeIntersections(surface).Pairs, 0u);
    const double voxels =
      FieldOf(block, "LabelVoxels") * map.Spacing[0] * map.Spacing[1] * map.Spacing[2];
    const double error = JudgeTopology(surface).Volume / voxels - 1.0;
    EXPECT_NEAR(error, 0.0, 0.03);
    EXPECT_NEAR(FieldOf(block, "VolumeError"), error, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, LabelVolumes,
  testing::Values(VolumeScene{ "Ball1To4", { 1.0, 1.0, 4.0 }, { 12.0, 12.0, 12.0 }, Ball(12.0) },
    VolumeScene{ "Ball1To8", { 1.0, 1.0, 8.0 }, { 19.0, 19.0, 19.0 }, Ball(19.0) },
    VolumeScene{ "Ball1To10", { 0.5, 0.5, 5.0 }, { 12.0, 12.0, 12.0 }, Ball(12.0) },
    VolumeScene{ "BallOfTwoSlices", { 1.0, 1.0, 12.0 }, { 12.0, 12.0, 12.0 }, Ball(12.0) },
    VolumeScene{ "Ball1To20", { 1.0, 1.0, 20.0 }, { 30.0, 30.0, 30.0 }, Ball(30.0) },
    VolumeScene{ "Skin", { 1.5, 1.5, 3.0 }, { 25.0, 25.0, 25.0 }, Skin(25.0, 4.0) },
    VolumeScene{ "SkinOfTwoVoxels", { 1.0, 1.0, 1.0 }, { 14.0, 14.0, 14.0 }, Skin(14.0, 2.0) },
    VolumeScene{ "WallOfTwoVoxels", { 1.0, 1.0, 1.0 }, { 9.0, 9.0, 12.0 }, Wall(9.0, 2.0, 12.0) },
    VolumeScene{ "Rib", { 1.5, 1.5, 5.0 }, { 36.0, 36.0, 15.0 }, IsInRib }),
  [](const testing::TestParamInfo<VolumeScene>& info) { return info.param.Name; });

TEST_P(LabelAccuracy, IsWithinBounds)
{
  const AccuracyBounds& bounds = GetParam();
  const DigitisedShapes shapes = Digitise(bounds.Kind, bounds.Size, bounds.Stretch);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  filter->SetVoxelTolerance(0.0);
  for (std::size_t s = 0; s < shapes.Shapes.size(); ++s)
  {
    const LabelShape& shape = shapes.Shapes[s];
    SCOPED_TRACE("label " + std::to_string(shape.Label));
    vtkPolyData* block = BlockOf(filter, static_cast<unsigned int>(s));
    ASSERT_EQ(FieldOf(block, "Label"), shape.Label);
    ExpectGoodTriangles(block);
    const TriangleSurface surface = ToTriangleSurface(block);
    const MisclassifiedVoxelVerdict voxels = JudgeVoxels(surface, shapes.Map, shape.Label);
    EXPECT_EQ(FieldOf(block, "LabelVoxels"), voxels.Label);
    EXPECT_EQ(FieldOf(block, "WrongVoxels"), voxels.Misclassified()) << "judge and filter differ";
    EXPECT_LE(voxels.Misclassified(), bounds.Wrong * voxels.Label)
      << voxels.Outside << " outside, " << voxels.Inside << " inside";
    if (shape.Volume > 0.0)
    {
      const TruthVerdict truth = JudgeTruth(surface, shape);
      EXPECT_LT(truth.MeanAtVertices, bounds.Distance);
      EXPECT_LT(truth.MeanAtCentroids, bounds.Distance);
      EXPECT_LT(truth.MeanAngle, bounds.Angle);
      EXPECT_NEAR(truth.VolumeError, 0.0, bounds.VolumeError);
    }
  }
}

// The targets are 0.1, 3 degrees, 0.002 and 0. Larger bounds are the errors that are reached.
INSTANTIATE_TEST_SUITE_P(Of, LabelAccuracy,
  testing::Values(
    AccuracyBounds{ "Sphere64", LabelShapeKind::Sphere, 64, 1.0, 0.1, 3.0, 0.002, 1e-4 },
    AccuracyBounds{ "Torus64", LabelShapeKind::Torus, 64, 1.0, 0.1, 3.1, 0.002, 3e-4 },
    AccuracyBounds{ "Torus112", LabelShapeKind::Torus, 112, 1.0, 0.1, 3.0, 0.002, 1e-4 },
    AccuracyBounds{ "Gyroid64", LabelShapeKind::Gyroid, 64, 1.0, 0.1, 4.8, 0.002, 1e-3 },
    AccuracyBounds{
      "TouchingBalls64", LabelShapeKind::TouchingBalls, 64, 1.0, 0.1, 3.2, 0.005, 5e-4 },
    AccuracyBounds{ "CutBall64", LabelShapeKind::CutBall, 64, 1.0, 0.1, 4.5, 0.015, 3e-3 },
    AccuracyBounds{ "Sphere64Stretched", LabelShapeKind::Sphere, 64, 3.0, 0.1, 3.0, 0.012, 6e-4 },
    AccuracyBounds{ "Torus64Stretched", LabelShapeKind::Torus, 64, 3.0, 0.11, 4.5, 0.02, 1e-3 }),
  [](const testing::TestParamInfo<AccuracyBounds>& info) { return std::string(info.param.Name); });

// Interpolating all voxel centres reproduces the errors of the digitisation.
TEST(LabelSurfaces, AreMoreAccurateByDefaultThanInterpolating)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::Sphere, 64);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  const auto judged = [&](double tolerance)
  {
    filter->SetVoxelTolerance(tolerance);
    return JudgeTruth(ToTriangleSurface(BlockOf(filter, 0)), shapes.Shapes[0]);
  };
  const TruthVerdict byDefault = judged(-1.0);
  const TruthVerdict interpolating = judged(0.0);
  EXPECT_LT(byDefault.MeanAngle, 0.8 * interpolating.MeanAngle);
  EXPECT_LT(byDefault.MeanAtVertices, interpolating.MeanAtVertices);
  EXPECT_LT(std::abs(byDefault.VolumeError), 0.002);
}

TEST(LabelSurfaces, CountWrongVoxelsFarFromTheLabel)
{
  // The coarse surface of a plate of four slices extends to six slices from it.
  LabelMap map = { { 20, 8, 30 }, { 1.0, 1.0, 1.0 }, {} };
  for (int slice = 0; slice < 30; ++slice)
  {
    map.Values.insert(map.Values.end(), 20 * 8, slice / 4 == 4 ? 5 : (slice - 2) / 6 == 1 ? 3 : 0);
  }
  const Filter filter = FilterOf(ToImage(map));
  filter->SetFinestLevel(2);
  const TriangleSurface plate = ToTriangleSurface(BlockOf(filter, 1));
  EXPECT_EQ(FieldOf(BlockOf(filter, 1), "WrongVoxels"), JudgeVoxels(plate, map, 5).Misclassified());
}
