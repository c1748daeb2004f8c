// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The levels follow equation 5: the sum of the kernel over positions in the interpolated image.
#include "FilterTestTools.h"

using namespace volumic;

namespace
{
/** Return V_h at a position in voxels of level h: trilinear, outside the nearest voxel. */
double Field(vtkImageData* image, std::array<double, 3> place)
{
  const int* size = image->GetDimensions();
  int low[3];
  int high[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double inside = std::clamp(place[axis], 0.0, size[axis] - 1.0);
    low[axis] = static_cast<int>(inside);
    high[axis] = std::min(low[axis] + 1, size[axis] - 1);
    share[axis] = inside - low[axis];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const bool up[3] = { (corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0 };
    double weight = 1.0;
    vtkIdType at[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      weight *= up[axis] ? share[axis] : 1.0 - share[axis];
      at[axis] = up[axis] ? high[axis] : low[axis];
    }
    const vtkIdType index = (at[2] * size[1] + at[1]) * size[0] + at[0];
    sum += weight * Voxels(image)->GetComponent(index, 0);
  }
  return sum;
}

/** Evaluate equation 5 directly: the sum over 125 positions, each from 8 voxels. */
double DirectSum(vtkImageData* below, const double* spacing, const std::array<int, 3>& voxel)
{
  const double kernel[5] = { 1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16. };
  const double unit = UnitOf(below);
  double sum = 0.0;
  ForBox({ -2, -2, -2 }, { 3, 3, 3 },
    [&](int m, int n, int p)
    {
      const int offset[3] = { m, n, p };
      std::array<double, 3> place;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double real = voxel[axis] * spacing[axis] + offset[axis] * unit;
        place[axis] = real / below->GetSpacing()[axis];
      }
      sum += kernel[m + 2] * kernel[n + 2] * kernel[p + 2] * Field(below, place);
    });
  return sum;
}

void ExpectDirectSums(vtkMultiBlockDataSet* pyramid, double tolerance)
{
  for (unsigned int h = 1; h < pyramid->GetNumberOfBlocks(); ++h)
  {
    vtkImageData* level = Level(pyramid, h);
    const int* size = level->GetDimensions();
    double worst = 0.0;
    vtkIdType index = 0;
    ForVoxels({ size[0], size[1], size[2] },
      [&](int i, int j, int k)
      {
        const double expected = DirectSum(Level(pyramid, h - 1), level->GetSpacing(), { i, j, k });
        worst = std::max(worst, std::abs(Voxels(level)->GetComponent(index, 0) - expected));
        ++index;
      });
    EXPECT_LE(worst, tolerance) << "level " << h;
  }
}

}

struct FactorAndSpacing
{
  double Factor;
  std::array<double, 3> Spacing;
};

class ImagePyramidAccuracy : public ::testing::TestWithParam<FactorAndSpacing>
{
};

TEST_P(ImagePyramidAccuracy, EqualsTheDirectSumOver125Places)
{
  const auto image = RandomImage(23, 18, 15);
  image->SetSpacing(GetParam().Spacing.data());
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(image);
  filter->SetReductionFactor(GetParam().Factor);
  filter->SetNumberOfLevels(3);
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 3u);
  ExpectDirectSums(filter->GetOutput(), 1e-5 * 100.0);
}

INSTANTIATE_TEST_SUITE_P(FactorsAndSpacings, ImagePyramidAccuracy,
  ::testing::Values(FactorAndSpacing{ std::sqrt(3.0), { 1, 1, 1 } },
    FactorAndSpacing{ 1.2, { 0.7, 0.9, 2.1 } }, FactorAndSpacing{ 1.9, { 3.0, 1.0, 1.1 } }));

TEST(ImagePyramid, Images2DWork)
{
  const auto image = RandomImage(90, 1, 70);
  image->SetSpacing(1, 0.001, 1);
  const auto filter = PyramidOf(image);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 4u);
  const int* size = Level(filter->GetOutput(), 3)->GetDimensions();
  EXPECT_EQ(size[0], 16);
  EXPECT_EQ(size[1], 1);
  EXPECT_EQ(size[2], 13);
  ExpectDirectSums(filter->GetOutput(), 1e-3);
}

class ImagePyramidScalarTypes : public ::testing::TestWithParam<int>
{
};

TEST_P(ImagePyramidScalarTypes, AreAllTaken)
{
  const auto image = RandomImage(20, 20, 20, GetParam());
  const auto filter = PyramidOf(image, 2);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(Voxels(Level(filter->GetOutput(), 0))->GetDataType(), GetParam());
  ExpectDirectSums(filter->GetOutput(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Types, ImagePyramidScalarTypes,
  ::testing::Values(VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT,
    VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG,
    VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE));
