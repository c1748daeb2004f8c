// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The levels hold what equation 5 says: the kernel's sum over places of the interpolated image.
#include "FilterTestTools.h"

#include <vtkDoubleArray.h>

using namespace volumic;

namespace
{
/** V_h at a place in voxels of level h: trilinear, past the border the nearest voxel. */
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

/** Equation 5, word by word: the sum over 125 places of the field, each from 8 voxels. */
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
        const double expected =
          DirectSum(Level(pyramid, h - 1), level->GetSpacing(), { i, j, k });
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
  ::testing::Values(FactorAndSpacing{ 1.2, { 1, 1, 1 } },
    FactorAndSpacing{ std::sqrt(3.0), { 1, 1, 1 } }, FactorAndSpacing{ 1.9, { 1, 1, 1 } },
    FactorAndSpacing{ 1.2, { 0.7, 0.9, 2.1 } }, FactorAndSpacing{ std::sqrt(3.0), { 1, 1, 2.5 } },
    FactorAndSpacing{ 1.9, { 3.0, 1.0, 1.1 } }));

TEST(ImagePyramid, DoublesAreComputedAsDoubles)
{
  const auto image = RandomImage(14, 11, 12, VTK_DOUBLE);
  const auto filter = PyramidOf(image, 3);
  ASSERT_TRUE(vtkDoubleArray::SafeDownCast(Voxels(Level(filter->GetOutput(), 1))));
  ExpectDirectSums(filter->GetOutput(), 1e-11);
}

TEST(ImagePyramid, ConstantsStayConstant)
{
  const auto image = RandomImage(33, 27, 21, VTK_SHORT);
  Voxels(image)->FillComponent(0, -1234);
  const auto filter = PyramidOf(image, 4);
  for (unsigned int h = 1; h < 4; ++h)
  {
    const double* range = Voxels(Level(filter->GetOutput(), h))->GetRange();
    EXPECT_NEAR(range[0], -1234, 1e-3);
    EXPECT_NEAR(range[1], -1234, 1e-3);
  }
}

TEST(ImagePyramid, ARampStaysThatRampInside)
{
  const auto image = RandomImage(48, 40, 36);
  image->SetSpacing(1, 1.5, 2);
  const auto ramp = [](const double* p) { return 3 * p[0] - 2 * p[1] + 0.5 * p[2] + 7; };
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    Voxels(image)->SetComponent(i, 0, ramp(image->GetPoint(i)));
  }
  const auto filter = PyramidOf(image, 3);
  vtkMultiBlockDataSet* pyramid = filter->GetOutput();
  // What the border changes reaches, at each level, two units and a voxel of interpolation further.
  std::array<double, 3> margin = { 0, 0, 0 };
  for (unsigned int h = 1; h < 3; ++h)
  {
    vtkImageData* below = Level(pyramid, h - 1);
    vtkImageData* level = Level(pyramid, h);
    for (int axis = 0; axis < 3; ++axis)
    {
      margin[axis] += 2 * UnitOf(below) + (h > 1 ? below->GetSpacing()[axis] : 0.0);
    }
    int inside = 0;
    for (vtkIdType i = 0; i < level->GetNumberOfPoints(); ++i)
    {
      const double* p = level->GetPoint(i);
      bool isInside = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        // The last voxel of a level lies up to a spacing before the end of the real image.
        const double end = below->GetBounds()[2 * axis + 1];
        isInside = isInside && p[axis] >= margin[axis] && p[axis] + margin[axis] <= end;
      }
      if (isInside)
      {
        ++inside;
        EXPECT_NEAR(Voxels(level)->GetComponent(i, 0), ramp(p), 1e-3);
      }
    }
    EXPECT_GT(inside, 50) << "level " << h;
  }
}

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
