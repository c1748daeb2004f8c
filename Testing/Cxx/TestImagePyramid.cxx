// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "SurfaceTestTools.h"

#include <vtkBitArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkImageCast.h>
#include <vtkImageInterpolator.h>
#include <vtkMatrix3x3.h>
#include <vtkSOADataArrayTemplate.h>

using namespace volumic;

namespace
{
/** A pyramid whose allocated levels are counted during a run. */
class ReleasedLevels : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Pyramid->SetInputData(BallImage(64, 60, 56, 0.3));
    this->Pyramid->SetNumberOfLevels(4);
    this->Pyramid->Update();
    for (unsigned int h = 0; h < 4; ++h)
    {
      this->Levels.emplace_back(Voxels(Level(this->Pyramid->GetOutput(), h)));
    }
    this->Filter->SetInputConnection(this->Pyramid->GetOutputPort());
    this->Filter->SetIsoValue(50.0);
  }

  int NumberHeld() const
  {
    return static_cast<int>(std::count_if(this->Levels.begin(), this->Levels.end(),
      [](const vtkWeakPointer<vtkDataArray>& voxels) { return voxels != nullptr; }));
  }

  vtkNew<vtkImagePyramid> Pyramid;
  vtkNew<vtkDeformableSurface> Filter;
  ProgressHook Hook{ this->Filter,
    [this](vtkAlgorithm*, const std::string& text, double)
    {
      for (std::size_t level = 0; level < 4; ++level)
      {
        if (text.find("Level " + std::to_string(level) + ", iteration") != std::string::npos)
        {
          this->Held[level] = std::max(this->Held[level], this->NumberHeld());
        }
      }
    } };
  std::vector<vtkWeakPointer<vtkDataArray>> Levels; ///< their voxels
  /** Maximum number of levels with voxels while the surface iterates on each level. */
  std::vector<int> Held = std::vector<int>(4, 0);
};
}

TEST(ImagePyramid, LevelsAreNamedAndCoverTheImage)
{
  const auto image = RandomImage(64, 50, 40, VTK_SHORT);
  image->SetExtent(5, 68, -7, 42, 100, 139);
  image->SetOrigin(10, 20, 30);
  image->SetSpacing(0.5, 0.75, 1.0);
  const double direction[9] = { 0, -1, 0, 0.6, 0, -0.8, 0.8, 0, 0.6 };
  image->SetDirectionMatrix(direction);
  double first[3];
  image->TransformIndexToPhysicalPoint(5, -7, 100, first);
  const auto filter = PyramidOf(image);
  vtkMultiBlockDataSet* pyramid = filter->GetOutput();
  ASSERT_EQ(pyramid->GetNumberOfBlocks(), 3u);
  EXPECT_EQ(StopReason(pyramid), "complete");
  for (int h = 0; h < 3; ++h)
  {
    SCOPED_TRACE(h);
    vtkImageData* level = Level(pyramid, h);
    EXPECT_STREQ(pyramid->GetMetaData(h)->Get(vtkCompositeDataSet::NAME()),
      ("Level " + std::to_string(h)).c_str());
    EXPECT_EQ(level->GetFieldData()->GetArray("Level")->GetComponent(0, 0), h);
    EXPECT_NEAR(UnitOf(level), 0.5 * std::pow(3.0, h / 2.0), 1e-12);
    EXPECT_STREQ(Voxels(level)->GetName(), "Voxels");
    EXPECT_EQ(Voxels(level)->GetDataType(), h == 0 ? VTK_SHORT : VTK_FLOAT);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ(level->GetExtent()[2 * axis], h == 0 ? image->GetExtent()[2 * axis] : 0);
      EXPECT_NEAR(level->GetOrigin()[axis], h == 0 ? image->GetOrigin()[axis] : first[axis], 1e-12);
      EXPECT_NEAR(level->GetSpacing()[axis] * level->GetDimensions()[axis],
        image->GetSpacing()[axis] * image->GetDimensions()[axis], 1e-12);
    }
    for (int i = 0; i < 9; ++i)
    {
      EXPECT_EQ(level->GetDirectionMatrix()->GetData()[i], direction[i]);
    }
  }
}

TEST(ImagePyramid, Level0SharesTheInputAndOthersHaveTheSelectedArray)
{
  const auto image = RandomImage(30, 30, 30);
  vtkNew<vtkDoubleArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  other->FillComponent(0, 5.0);
  image->GetPointData()->AddArray(other);
  const auto filter = PyramidOf(image, 2);
  vtkImageData* level0 = Level(filter->GetOutput(), 0);
  EXPECT_EQ(Voxels(level0), Voxels(image)) << "the very array, not a copy";
  EXPECT_TRUE(level0->GetPointData()->HasArray("Other"));
  EXPECT_FALSE(image->GetFieldData()->HasArray("Level")) << "the input itself is left alone";
  EXPECT_EQ(Level(filter->GetOutput(), 1)->GetPointData()->GetNumberOfArrays(), 1);

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Other");
  filter->Update();
  for (const unsigned int h : { 0u, 1u })
  {
    EXPECT_STREQ(Voxels(Level(filter->GetOutput(), h))->GetName(), "Other");
  }
  EXPECT_NEAR(Voxels(Level(filter->GetOutput(), 1))->GetComponent(99, 0), 5.0, 1e-12);
  EXPECT_STREQ(Voxels(image)->GetName(), "Voxels") << "the input's active scalars stay";
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
      SCOPED_TRACE(::testing::Message() << threads << " threads, level " << h);
      ExpectSameArrays(Level(other->GetOutput(), h)->GetPointData(),
        Level(filter->GetOutput(), h)->GetPointData());
    }
  }
}

TEST(ImagePyramid, AcceptsOtherMemoryLayouts)
{
  const auto image = ImageOf(
    { 20, 20, 20 }, [](int, int j, int) { return j < 10 ? 1.0 : 0.0; }, VTK_FLOAT, "Mask");
  const auto expected = PyramidOf(image, 2);
  for (const vtkSmartPointer<vtkDataArray>& voxels :
    { vtkSmartPointer<vtkDataArray>(vtkSmartPointer<vtkSOADataArrayTemplate<float>>::New()),
      vtkSmartPointer<vtkDataArray>(vtkSmartPointer<vtkBitArray>::New()) })
  {
    voxels->DeepCopy(Voxels(image));
    vtkNew<vtkImageData> other;
    other->SetDimensions(20, 20, 20);
    other->GetPointData()->SetScalars(voxels);
    ExpectSameArrays(Level(PyramidOf(other, 2)->GetOutput(), 1)->GetPointData(),
      Level(expected->GetOutput(), 1)->GetPointData());
  }
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

TEST(ImagePyramid, ReportsProgressAndKeepsFinishedLevelsIfCancelled)
{
  vtkNew<vtkImagePyramid> filter;
  filter->SetInputData(ImageOf(
    { 256, 256, 256 }, [](int, int, int) { return 1.0; }, VTK_UNSIGNED_CHAR));
  filter->SetNumberOfLevels(3);
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  const auto inside = [](double share) { return share > 0.01 && share < 0.5; };
  EXPECT_TRUE(std::any_of(listener.Shares.begin(), listener.Shares.end(), inside));
  EXPECT_EQ(listener.Shares.back(), 1.0);
  EXPECT_TRUE(listener.Texts.count("Level 1 of 2"));
  EXPECT_TRUE(listener.Texts.count("Level 2 of 2"));
  listener.StopAt = 0.83; // level 1 is 0.84 of the work
  filter->Modified();
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(StopReason(filter->GetOutput()), "cancelled");
  const double* range = Voxels(Level(filter->GetOutput(), 1))->GetRange();
  EXPECT_NEAR(range[0], 1.0, 1e-6) << "what is handed over is finished";
  EXPECT_NEAR(range[1], 1.0, 1e-6);
}

namespace
{
/**
 * Evaluate equation 5 at a position directly: the sum over 125 positions, each from 8 voxels.
 * @param field V_h at positions in voxels: trilinear, outside the nearest voxel
 */
double DirectSum(vtkImageInterpolator* field, double unit, const double* spacing, const double* at)
{
  const double kernel[5] = { 1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16. };
  double sum = 0.0;
  ForBox({ -2, -2, -2 }, { 3, 3, 3 },
    [&](int m, int n, int p)
    {
      const double position[3] = { (at[0] + m * unit) / spacing[0], (at[1] + n * unit) / spacing[1],
        (at[2] + p * unit) / spacing[2] };
      double value;
      field->InterpolateIJK(position, &value);
      sum += kernel[m + 2] * kernel[n + 2] * kernel[p + 2] * value;
    });
  return sum;
}

void ExpectDirectSums(vtkMultiBlockDataSet* pyramid, double tolerance)
{
  for (unsigned int h = 1; h < pyramid->GetNumberOfBlocks(); ++h)
  {
    vtkImageData* below = Level(pyramid, h - 1);
    vtkImageData* level = Level(pyramid, h);
    vtkNew<vtkImageCast> cast; // vtkImageInterpolator does not accept all types.
    cast->SetInputData(below);
    cast->SetOutputScalarTypeToDouble();
    cast->Update();
    vtkNew<vtkImageInterpolator> field;
    field->Initialize(cast->GetOutput());
    double worst = 0.0;
    for (vtkIdType v = 0; v < level->GetNumberOfPoints(); ++v)
    {
      const double expected =
        DirectSum(field, UnitOf(below), below->GetSpacing(), level->GetPoint(v));
      worst = std::max(worst, std::abs(Voxels(level)->GetComponent(v, 0) - expected));
    }
    EXPECT_LE(worst, tolerance) << "level " << h;
  }
}
}

TEST(ImagePyramidAccuracy, EqualsTheDirectSumOver125Places)
{
  for (const auto& [factor, spacing] : std::map<double, std::array<double, 3>>{
         { std::sqrt(3.0), { 1, 1, 1 } }, { 1.2, { 0.7, 0.9, 2.1 } }, { 1.9, { 3.0, 1.0, 1.1 } } })
  {
    SCOPED_TRACE(factor);
    const auto image = RandomImage(23, 18, 15);
    image->SetSpacing(spacing.data());
    vtkNew<vtkImagePyramid> filter;
    filter->SetInputData(image);
    filter->SetReductionFactor(factor);
    filter->SetNumberOfLevels(3);
    filter->Update();
    ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 3u);
    ExpectDirectSums(filter->GetOutput(), 1e-5 * 100.0);
  }
}

TEST(ImagePyramidAccuracy, Images2DWork)
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

TEST(ImagePyramidAccuracy, AcceptsAllScalarTypes)
{
  for (const int type : { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT,
         VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE })
  {
    SCOPED_TRACE(type);
    const auto filter = PyramidOf(RandomImage(20, 20, 20, type), 2);
    ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
    EXPECT_EQ(Voxels(Level(filter->GetOutput(), 0))->GetDataType(), type);
    ExpectDirectSums(filter->GetOutput(), 1e-3);
  }
}

TEST_F(ReleasedLevels, AreReleasedOneByOne)
{
  this->Pyramid->ReleaseDataFlagOn();
  this->Filter->Update();
  EXPECT_EQ(this->Held, (std::vector<int>{ 1, 2, 3, 4 }));
  EXPECT_EQ(this->NumberHeld(), 1) << "level 0 is the image that the pyramid was given";
  EXPECT_EQ(StopReason(this->Filter->GetOutput()), "converged");
}

TEST_F(ReleasedLevels, StayWithTheOwnerOfThePyramid)
{
  this->Filter->Update();
  EXPECT_EQ(this->Held, (std::vector<int>{ 4, 4, 4, 4 }));
  EXPECT_EQ(this->NumberHeld(), 4);
}

TEST_F(ReleasedLevels, AreKeptWhileTheRunCanResume)
{
  this->Filter->SetFinestLevel(2);
  this->Filter->Update();
  this->Pyramid->GetOutput()->Initialize();
  EXPECT_EQ(this->NumberHeld(), 3) << "level 3 has been left";
  this->Filter->ForgetRun();
  EXPECT_EQ(this->NumberHeld(), 1);
}
