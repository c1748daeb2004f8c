// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"
#include "vtkImagePyramid.h"

#include <vtkBitArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRTAnalyticSource.h>
#include <vtkSMPTools.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace volumic;

namespace
{
vtkImageData* Level(vtkMultiBlockDataSet* pyramid, unsigned int h)
{
  return vtkImageData::SafeDownCast(pyramid->GetBlock(h));
}

vtkDataArray* Voxels(vtkImageData* image)
{
  return image->GetPointData()->GetScalars();
}

double UnitOf(vtkImageData* level)
{
  return level->GetFieldData()->GetArray("Unit")->GetComponent(0, 0);
}

vtkSmartPointer<vtkImagePyramid> PyramidOf(vtkImageData* image, int levels = 0)
{
  auto pyramid = vtkSmartPointer<vtkImagePyramid>::New();
  pyramid->SetInputData(image);
  pyramid->SetNumberOfLevels(levels);
  pyramid->Update();
  return pyramid;
}

/// V_h at a place in voxels of level h: trilinear, past the border the nearest voxel.
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

/// Equation 5, word by word: the sum over 125 places of the field, each from 8 voxels.
double DirectSum(vtkImageData* below, const double* spacing, const std::array<int, 3>& voxel)
{
  const double kernel[5] = { 1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16. };
  const double unit = UnitOf(below);
  double sum = 0.0;
  for (int p = -2; p <= 2; ++p)
  {
    for (int n = -2; n <= 2; ++n)
    {
      for (int m = -2; m <= 2; ++m)
      {
        const int offset[3] = { m, n, p };
        std::array<double, 3> place;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double real = voxel[axis] * spacing[axis] + offset[axis] * unit;
          place[axis] = real / below->GetSpacing()[axis];
        }
        sum += kernel[m + 2] * kernel[n + 2] * kernel[p + 2] * Field(below, place);
      }
    }
  }
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
    for (int k = 0; k < size[2]; ++k)
    {
      for (int j = 0; j < size[1]; ++j)
      {
        for (int i = 0; i < size[0]; ++i, ++index)
        {
          const double expected =
            DirectSum(Level(pyramid, h - 1), level->GetSpacing(), { i, j, k });
          worst = std::max(worst, std::abs(Voxels(level)->GetComponent(index, 0) - expected));
        }
      }
    }
    EXPECT_LE(worst, tolerance) << "level " << h;
  }
}

bool AreSameVoxels(vtkImageData* a, vtkImageData* b)
{
  vtkDataArray* u = Voxels(a);
  vtkDataArray* v = Voxels(b);
  if (u->GetNumberOfValues() != v->GetNumberOfValues())
  {
    return false;
  }
  for (vtkIdType i = 0; i < u->GetNumberOfValues(); ++i)
  {
    if (u->GetComponent(i, 0) != v->GetComponent(i, 0))
    {
      return false;
    }
  }
  return true;
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

TEST(ImagePyramid, BlocksAreNamedAndDescribed)
{
  const auto image = RandomImage(64, 50, 40, VTK_SHORT);
  image->SetSpacing(0.5, 0.75, 1.0);
  const auto filter = PyramidOf(image);
  vtkMultiBlockDataSet* pyramid = filter->GetOutput();
  ASSERT_EQ(pyramid->GetNumberOfBlocks(), 3u);
  for (int h = 0; h < 3; ++h)
  {
    vtkImageData* level = Level(pyramid, h);
    EXPECT_STREQ(pyramid->GetMetaData(h)->Get(vtkCompositeDataSet::NAME()),
      ("Level " + std::to_string(h)).c_str());
    EXPECT_EQ(level->GetFieldData()->GetArray("Level")->GetComponent(0, 0), h);
    EXPECT_NEAR(UnitOf(level), 0.5 * std::pow(3.0, h / 2.0), 1e-12);
    EXPECT_STREQ(Voxels(level)->GetName(), "Voxels");
    EXPECT_EQ(Voxels(level)->GetDataType(), h == 0 ? VTK_SHORT : VTK_FLOAT);
  }
  auto* reason =
    vtkStringArray::SafeDownCast(pyramid->GetFieldData()->GetAbstractArray("StopReason"));
  ASSERT_TRUE(reason);
  EXPECT_EQ(reason->GetValue(0), "complete");
}

TEST(ImagePyramid, Level0SharesTheInput)
{
  const auto image = RandomImage(30, 30, 30);
  vtkNew<vtkFloatArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  image->GetPointData()->AddArray(other);
  const auto filter = PyramidOf(image, 2);
  vtkImageData* level0 = Level(filter->GetOutput(), 0);
  EXPECT_EQ(Voxels(level0), Voxels(image)) << "the very array, not a copy";
  EXPECT_TRUE(level0->GetPointData()->HasArray("Other"));
  EXPECT_FALSE(image->GetFieldData()->HasArray("Level")) << "the input itself is left alone";
  EXPECT_EQ(Level(filter->GetOutput(), 1)->GetPointData()->GetNumberOfArrays(), 1);
}

TEST(ImagePyramid, KeepsThePlaceOfTheFirstVoxelAndTheRealSize)
{
  const auto image = RandomImage(40, 30, 20);
  image->SetExtent(5, 44, -7, 22, 100, 119);
  image->SetOrigin(10, 20, 30);
  image->SetSpacing(0.5, 2.0, 1.5);
  const double direction[9] = { 0, -1, 0, 0.6, 0, -0.8, 0.8, 0, 0.6 };
  image->SetDirectionMatrix(direction);
  double first[3];
  image->TransformIndexToPhysicalPoint(5, -7, 100, first);
  const auto filter = PyramidOf(image, 3);
  for (unsigned int h = 1; h < 3; ++h)
  {
    vtkImageData* level = Level(filter->GetOutput(), h);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ(level->GetExtent()[2 * axis], 0);
      EXPECT_NEAR(level->GetOrigin()[axis], first[axis], 1e-12);
      EXPECT_NEAR(level->GetSpacing()[axis] * level->GetDimensions()[axis],
        image->GetSpacing()[axis] * image->GetDimensions()[axis], 1e-12);
    }
    for (int i = 0; i < 9; ++i)
    {
      EXPECT_EQ(level->GetDirectionMatrix()->GetData()[i], direction[i]);
    }
  }
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

TEST(ImagePyramid, IsTheSameBitsForAnyNumberOfThreads)
{
  const auto image = RandomImage(150, 130, 60, VTK_SHORT);
  const auto filter = PyramidOf(image);
  for (const int threads : { 1, 2, 5 })
  {
    vtkNew<vtkImagePyramid> other;
    other->SetInputData(image);
    other->SetNumberOfThreads(threads);
    other->Update();
    ASSERT_EQ(other->GetOutput()->GetNumberOfBlocks(), filter->GetOutput()->GetNumberOfBlocks());
    for (unsigned int h = 1; h < other->GetOutput()->GetNumberOfBlocks(); ++h)
    {
      EXPECT_TRUE(AreSameVoxels(Level(other->GetOutput(), h), Level(filter->GetOutput(), h)))
        << threads << " threads, level " << h;
    }
  }
}

TEST(ImagePyramid, IsTheSameBitsOnEveryBackend)
{
  const auto image = RandomImage(150, 60, 60);
  const auto filter = PyramidOf(image);
  const std::string host = vtkSMPTools::GetBackend();
  for (const char* backend : { "Sequential", "STDThread" })
  {
    ASSERT_TRUE(vtkSMPTools::SetBackend(backend));
    const auto other = PyramidOf(image);
    EXPECT_TRUE(AreSameVoxels(Level(other->GetOutput(), 1), Level(filter->GetOutput(), 1)));
    EXPECT_EQ(std::string(vtkSMPTools::GetBackend()), backend) << "the host's choice is restored";
  }
  vtkSMPTools::SetBackend(host.c_str());
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

TEST(ImagePyramid, TakesTheChosenArray)
{
  const auto image = RandomImage(30, 30, 30);
  vtkNew<vtkDoubleArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  other->FillComponent(0, 5.0);
  image->GetPointData()->AddArray(other);
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(image);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Other");
  filter->Update();
  for (unsigned int h = 0; h < filter->GetOutput()->GetNumberOfBlocks(); ++h)
  {
    EXPECT_STREQ(Voxels(Level(filter->GetOutput(), h))->GetName(), "Other");
  }
  EXPECT_NEAR(Voxels(Level(filter->GetOutput(), 1))->GetComponent(99, 0), 5.0, 1e-12);
  EXPECT_STREQ(Voxels(image)->GetName(), "Voxels") << "the input's active scalars stay";
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

TEST(ImagePyramid, TakesArraysOfOtherMemoryLayouts)
{
  const auto image = RandomImage(20, 20, 20);
  const auto expected = PyramidOf(image, 2);
  vtkNew<vtkSOADataArrayTemplate<float>> apart;
  apart->DeepCopy(Voxels(image));
  vtkNew<vtkImageData> other;
  other->SetDimensions(20, 20, 20);
  other->GetPointData()->SetScalars(apart);
  EXPECT_TRUE(
    AreSameVoxels(Level(PyramidOf(other, 2)->GetOutput(), 1), Level(expected->GetOutput(), 1)));

  vtkNew<vtkBitArray> bits;
  bits->SetNumberOfTuples(8000);
  for (vtkIdType i = 0; i < 8000; ++i)
  {
    bits->SetValue(i, i % 400 < 200 ? 1 : 0);
    Voxels(image)->SetComponent(i, 0, i % 400 < 200 ? 1 : 0);
  }
  vtkNew<vtkImageData> mask;
  mask->SetDimensions(20, 20, 20);
  mask->GetPointData()->SetScalars(bits);
  Voxels(image)->Modified();
  image->Modified();
  EXPECT_TRUE(AreSameVoxels(
    Level(PyramidOf(mask, 2)->GetOutput(), 1), Level(PyramidOf(image, 2)->GetOutput(), 1)));
}

TEST(ImagePyramid, AsksASourceForItsWholeExtent)
{
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-20, 20, -15, 15, 2, 30);
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  EXPECT_EQ(Level(filter->GetOutput(), 0)->GetNumberOfPoints(), 41 * 31 * 29);
  EXPECT_EQ(Level(filter->GetOutput(), 1)->GetDimensions()[0], 23);
}

TEST(ImagePyramid, ExecutesAgainWhenAPropertyChanges)
{
  const auto image = RandomImage(40, 40, 40);
  const auto filter = PyramidOf(image, 2);
  filter->SetNumberOfLevels(3);
  filter->SetReductionFactor(1.5);
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 3u);
  EXPECT_EQ(Level(filter->GetOutput(), 1)->GetDimensions()[0], 26);
  filter->SetNumberOfLevels(0);
  filter->SetMinimumLevelSize(26);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
}

TEST(ImagePyramid, PrintsItsProperties)
{
  vtkNew<vtkImagePyramid> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* property : { "ReductionFactor: 1.73205", "NumberOfLevels: 0",
         "MinimumLevelSize: 10", "NumberOfThreads: 0" })
  {
    EXPECT_NE(text.str().find(property), std::string::npos) << property;
  }
}
