// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Voxels far from zero with small differences. At 10^9 single precision has steps of 64.
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
constexpr double Far = 1e9;

/** Return BallImage(40, 40, 40) with integers from `base` to `base` + 50. */
vtkSmartPointer<vtkImageData> BallAt(double base, int scalarType)
{
  const auto ball = BallImage(40, 40, 40);
  return ImageOf(
    { 40, 40, 40 },
    [&](int i, int j, int k)
    { return base + std::round(0.5 * ball->GetScalarComponentAsDouble(i, j, k, 0)); },
    scalarType);
}

vtkSmartPointer<vtkDeformableSurface> SurfaceAbove(
  double base, int scalarType, const Choice& choose)
{
  const auto filter = FilterOf(BallAt(base, scalarType), choose);
  filter->SetIsoValue(base + 25.5);
  EXPECT_EQ(MessagesOfUpdate(filter), "");
  return filter;
}

class FarFromZero : public ::testing::TestWithParam<int>
{
};
}

TEST_P(FarFromZero, PyramidPreservesDifferences)
{
  const auto pyramid = PyramidOf(BallAt(Far, GetParam()));
  const auto nearby = PyramidOf(BallAt(0.0, VTK_SHORT));
  ASSERT_EQ(pyramid->GetErrorCode(), 0u);
  for (unsigned int h = 1; h < pyramid->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    vtkDataArray* voxels = Voxels(Level(pyramid->GetOutput(), h));
    ASSERT_EQ(voxels->GetDataType(), VTK_DOUBLE);
    for (vtkIdType i = 0; i < voxels->GetNumberOfTuples(); ++i)
    {
      const double expected = Voxels(Level(nearby->GetOutput(), h))->GetComponent(i, 0);
      ASSERT_NEAR(voxels->GetComponent(i, 0) - Far, expected, 1e-4) << "level " << h;
    }
  }
}

TEST_P(FarFromZero, SurfaceIsThatOfVoxelsNearZero)
{
  for (const bool isSingleLevel : { true, false })
  {
    SCOPED_TRACE(isSingleLevel);
    const Choice set = [=](vtkDeformableSurface* f)
    { f->SetCoarsestLevel(isSingleLevel ? 0 : -1); };
    const auto nearby = SurfaceAbove(0.0, VTK_SHORT, set);
    const auto far = SurfaceAbove(Far, GetParam(), set);
    ASSERT_GT(far->GetOutput()->GetNumberOfPoints(), 100);
    EXPECT_EQ(StopReason(far->GetOutput()), "converged");
    // Only the voxels of level 0 are the same in every bit.
    EXPECT_TRUE(!isSingleLevel || AreSameSurfaces(far->GetOutput(), nearby->GetOutput()));
    EXPECT_NEAR(
      FieldOf(far->GetOutput(), "Volume") / FieldOf(nearby->GetOutput(), "Volume"), 1.0, 1e-3);
    vtkDataArray* residual = far->GetOutput()->GetPointData()->GetArray("Residual");
    vtkDataArray* expected = nearby->GetOutput()->GetPointData()->GetArray("Residual");
    EXPECT_NEAR(residual->GetRange()[1], expected->GetRange()[1], 5.0) << "relative to IsoValue";
    EXPECT_NEAR(residual->GetRange()[0], expected->GetRange()[0], 5.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
  Types, FarFromZero, ::testing::Values(VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_DOUBLE));

TEST(FarFromZeroFloat, InterpolatesBetweenRoundedVoxels)
{
  // At 10^6 float has steps of 1/16. Interpolated values must not be rounded to these.
  const auto filter =
    SurfaceAbove(1e6, VTK_FLOAT, [](vtkDeformableSurface* f) { f->SetCoarsestLevel(0); });
  vtkDataArray* residual = filter->GetOutput()->GetPointData()->GetArray("Residual");
  ASSERT_TRUE(residual);
  int between = 0;
  for (vtkIdType i = 0; i < residual->GetNumberOfTuples(); ++i)
  {
    const double steps = 16.0 * residual->GetComponent(i, 0);
    between += std::abs(steps - std::round(steps)) > 1e-4;
  }
  EXPECT_GT(between, residual->GetNumberOfTuples() / 2);
}

TEST(FarFromZeroFloat, SmallIntegersGiveFloatLevels)
{
  for (const double base : { 0.0, -1024.0, 5000.0 })
  {
    const auto pyramid = PyramidOf(BallAt(base, VTK_INT));
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 1))->GetDataType(), VTK_FLOAT) << base;
  }
}
