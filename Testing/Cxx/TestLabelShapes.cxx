// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Accuracy of vtkLabelsToSurfaces for analytic shapes, measured by an independent implementation.
#include "JudgedLabels.h"

using namespace volumic::support;

namespace
{
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
} // namespace

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
