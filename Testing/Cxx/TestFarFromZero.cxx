// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Voxels that lie far from zero beside what they differ by, such as times, counters and addresses:
// single precision has steps of 64 at 10^9.
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
constexpr double Far = 1e9;

/** BallImage(40, 40, 40) in whole steps from `base` to `base` + 50. */
vtkSmartPointer<vtkImageData> BallAt(double base, int scalarType)
{
  const auto ball = BallImage(40, 40, 40);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->CopyStructure(ball);
  image->AllocateScalars(scalarType, 1);
  Voxels(image)->SetName("Voxels");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    Voxels(image)->SetComponent(i, 0, base + std::round(0.5 * Voxels(ball)->GetComponent(i, 0)));
  }
  return image;
}

class FarFromZero : public ::testing::TestWithParam<int>
{
protected:
  /** The surface of the far ball must be that of the same one near zero. */
  static void ExpectSame(double tolerance, const std::function<void(vtkDeformableSurface*)>& set)
  {
    vtkNew<vtkDeformableSurface> nearby;
    nearby->SetInputDataObject(BallAt(0.0, VTK_SHORT));
    nearby->SetIsoValue(25.5);
    set(nearby);
    nearby->Update();
    vtkNew<vtkDeformableSurface> far;
    far->SetInputDataObject(BallAt(Far, GetParam()));
    far->SetIsoValue(Far + 25.5);
    set(far);
    const MessagesOf errors(far);
    far->Update();
    ASSERT_EQ(errors.Get(), "");
    ASSERT_GT(far->GetOutput()->GetNumberOfPoints(), 100);
    EXPECT_EQ(StopReason(far->GetOutput()), "converged");
    EXPECT_NEAR(FieldOf(far->GetOutput(), "Volume") / FieldOf(nearby->GetOutput(), "Volume"), 1.0,
      tolerance);
    if (tolerance == 0.0)
    {
      EXPECT_TRUE(AreSameSurfaces(far->GetOutput(), nearby->GetOutput()));
    }
    vtkDataArray* residual = far->GetOutput()->GetPointData()->GetArray("Residual");
    vtkDataArray* expected = nearby->GetOutput()->GetPointData()->GetArray("Residual");
    EXPECT_NEAR(residual->GetRange()[1], expected->GetRange()[1], 5.0) << "relative to IsoValue";
    EXPECT_NEAR(residual->GetRange()[0], expected->GetRange()[0], 5.0);
  }

  static void OnOneLevel(vtkDeformableSurface* filter)
  {
    filter->SetCoarsestLevel(0);
    filter->SetFinestLevel(0);
  }
};
}

TEST_P(FarFromZero, APyramidKeepsTheDifferences)
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

TEST_P(FarFromZero, OneLevelGivesTheSameBits)
{
  ExpectSame(0.0, OnOneLevel);
}

TEST_P(FarFromZero, ThroughThePyramid)
{
  ExpectSame(1e-3, [](vtkDeformableSurface*) {});
}

INSTANTIATE_TEST_SUITE_P(Types, FarFromZero,
  ::testing::Values(VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_DOUBLE));

TEST(FarFromZeroFloat, VoxelsAreNotRoundedAnyFurther)
{
  // Steps of 1/16 at 10^6: the voxels hold the ball; what is interpolated between them must not be
  // rounded to such steps.
  const auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
  filter->SetInputDataObject(BallAt(1e6, VTK_FLOAT));
  filter->SetIsoValue(1e6 + 25.5);
  filter->SetCoarsestLevel(0);
  filter->Update();
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

TEST(FarFromZeroFloat, LevelsOfOtherIntegersStayFloat)
{
  for (const double base : { 0.0, -1024.0, 5000.0 })
  {
    const auto pyramid = PyramidOf(BallAt(base, VTK_INT));
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 1))->GetDataType(), VTK_FLOAT) << base;
  }
}
