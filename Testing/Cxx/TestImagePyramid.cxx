// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"

#include <vtkBitArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>

using namespace volumic;

namespace
{
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

std::string StopReason(vtkMultiBlockDataSet* pyramid)
{
  auto* reason =
    vtkStringArray::SafeDownCast(pyramid->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}
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
  EXPECT_EQ(StopReason(pyramid), "complete");
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

TEST(ImagePyramid, KeepsThePositionOfTheFirstVoxelAndThePhysicalSize)
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

TEST(ImagePyramid, IsBitIdenticalForAnyNumberOfThreads)
{
  const auto image = RandomImage(150, 130, 60, VTK_SHORT);
  const auto filter = PyramidOf(image);
  for (const int threads : { 1, 2, 5 })
  {
    const auto other = Updated<vtkImagePyramid>(
      image, [threads](vtkImagePyramid* p) { p->SetNumberOfThreads(threads); });
    ASSERT_EQ(other->GetOutput()->GetNumberOfBlocks(), filter->GetOutput()->GetNumberOfBlocks());
    for (unsigned int h = 1; h < other->GetOutput()->GetNumberOfBlocks(); ++h)
    {
      EXPECT_TRUE(AreSameVoxels(Level(other->GetOutput(), h), Level(filter->GetOutput(), h)))
        << threads << " threads, level " << h;
    }
  }
}

TEST(ImagePyramid, UsesTheSelectedArray)
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

TEST(ImagePyramid, AcceptsOtherMemoryLayouts)
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

TEST(ImagePyramid, CountsLevels)
{
  for (const std::array<int, 3> size :
    { std::array<int, 3>{ 64, 50, 40 }, { 8, 9, 200 }, { 30, 40, 1 } })
  {
    for (const int levels : { 0, 2 })
    {
      const auto filter = PyramidOf(RandomImage(size[0], size[1], size[2], VTK_SHORT));
      filter->SetNumberOfLevels(levels);
      filter->SetMinimumLevelSize(5);
      filter->SetReductionFactor(1.5);
      filter->Update();
      EXPECT_EQ(filter->CountLevels(size[0], size[1], size[2]),
        static_cast<int>(filter->GetOutput()->GetNumberOfBlocks()));
    }
  }
  vtkNew<vtkImagePyramid> filter;
  filter->SetNumberOfLevels(100);
  EXPECT_EQ(filter->CountLevels(64, 50, 40), 0) << "more than there can be";
  filter->SetNumberOfLevels(0);
  EXPECT_EQ(filter->CountLevels(0, 0, 0), 0) << "no image";
}

namespace
{
vtkSmartPointer<vtkImageData> LargeImage()
{
  return ImageOf(
    { 256, 256, 256 }, [](int, int, int) { return 1.0; }, VTK_UNSIGNED_CHAR);
}

class ImagePyramidProgress : public ::testing::Test
{
protected:
  /** Stops a run at a share of the work, if it is less than 1. */
  void Run(double stopAt)
  {
    this->Listener.StopAt = stopAt;
    this->Filter->SetInputData(LargeImage());
    this->Filter->SetNumberOfLevels(3);
    this->Filter->Update();
  }

  vtkNew<vtkImagePyramid> Filter;
  ProgressListener Listener{ this->Filter };
};
}

TEST_F(ImagePyramidProgress, GrowsWithinALevelAndNamesIt)
{
  this->Run(2.0);
  EXPECT_TRUE(std::is_sorted(this->Listener.Shares.begin(), this->Listener.Shares.end()));
  const auto inside = [](double share) { return share > 0.01 && share < 0.5; };
  EXPECT_TRUE(std::any_of(this->Listener.Shares.begin(), this->Listener.Shares.end(), inside));
  EXPECT_EQ(this->Listener.Shares.back(), 1.0);
  EXPECT_TRUE(this->Listener.Texts.count("Level 1 of 2"));
  EXPECT_TRUE(this->Listener.Texts.count("Level 2 of 2"));
}

TEST_F(ImagePyramidProgress, CancellingBetweenLevelsKeepsTheFinishedOnes)
{
  this->Run(0.83); // level 1 is 0.84 of the work
  ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "cancelled");
  const double* range = Voxels(Level(this->Filter->GetOutput(), 1))->GetRange();
  EXPECT_NEAR(range[0], 1.0, 1e-6) << "what is handed over is finished";
  EXPECT_NEAR(range[1], 1.0, 1e-6);
}
