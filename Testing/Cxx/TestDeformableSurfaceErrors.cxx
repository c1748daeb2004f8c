// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkCellArray.h>
#include <vtkExecutive.h>
#include <vtkReverseSense.h>
#include <vtkTable.h>

using namespace volumic;

namespace
{
/** A valid filter. Each test makes one setting or input invalid, and expects an error. */
class DeformableSurfaceErrors : public ::testing::Test
{
protected:
  void ExpectError(const std::vector<std::string>& parts)
  {
    ExpectErrorOf(this->Filter, parts);
    EXPECT_EQ(this->Filter->GetLevels()->GetNumberOfBlocks(), 0u);
    EXPECT_EQ(this->Filter->GetHistory()->GetNumberOfRows(), 0);
  }

  vtkSmartPointer<vtkMultiBlockDataSet> Pyramid()
  {
    auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    blocks->DeepCopy(PyramidOf(BallImage(32, 32, 32))->GetOutput());
    return blocks;
  }

  const vtkSmartPointer<vtkDeformableSurface> Filter = FilterOf(BallImage(32, 32, 32));
};
}

TEST_F(DeformableSurfaceErrors, ReportsInvalidPropertiesAndInputs)
{
  const double infinite = std::numeric_limits<double>::infinity();
  const auto placed = [](double spacing, double origin)
  {
    const auto image = BallImage(16, 16, 16);
    image->SetSpacing(1.0, 1.0, spacing);
    image->SetOrigin(origin, 0.0, 0.0);
    return image;
  };
  std::vector<ErrorCase<vtkDeformableSurface>> cases = {
    { [](vtkDeformableSurface* f) { f->SetIsoValue(std::nan("")); },
      { "Iso Value is not set", "range from 0 to 100" } },
    { [](vtkDeformableSurface* f) { f->SetInputDataObject(RandomImage(64, 64, 1)); },
      { "Input port 0", "2D", "64 x 64 x 1" } },
    { [](vtkDeformableSurface* f) { f->SetInputDataObject(RandomImage(64, 7, 64)); },
      { "Input port 0", "64 x 7 x 64", "at least 8" } },
    { [](vtkDeformableSurface* f)
      { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Density"); },
      { "no point array 'Density'", "'Voxels'" } },
    { [](vtkDeformableSurface* f) { f->SetCoarsestLevel(5); },
      { "Coarsest Level is 5", "levels 0 to 2" } },
    { [](vtkDeformableSurface* f) { f->SetCoarsestLevel(1), f->SetFinestLevel(2); },
      { "Finest Level is 2", "Set it to 0 to 1, the coarsest level" } },
    { [](vtkDeformableSurface* f) { f->SetFinestLevel(-2); },
      { "Finest Level is -2", "or to -1 for a subdivision" } },
    { [](vtkDeformableSurface* f)
      {
        const auto image = ImageOf({ 40, 40, 40 }, [](int, int, int) { return 0.0; });
        FillBox(image, { 20, 20, 20 }, { 21, 21, 21 });
        f->SetInputDataObject(image);
        f->SetCoarsestLevel(2);
      },
      { "coarsest level, 2", "above Iso Value 50", "Set Coarsest Level to 0" } },
    { [](vtkDeformableSurface* f) { f->SetKeepComponents(5); }, { "Keep Components is 5" } },
    { [](vtkDeformableSurface* f)
      { f->SetKeepComponentsToLargeComponents(), f->SetMinimumComponentVolume(-1.0); },
      { "Minimum Component Volume is -1" } },
    { [](vtkDeformableSurface* f) { f->SetTimeLimit(-1.0); }, { "Time Limit is -1" } },
    { [](vtkDeformableSurface* f) { f->SetTimeLimit(std::nan("")); }, { "Time Limit is nan" } },
    { [](vtkDeformableSurface* f) { f->SetInitialization(4); },
      { "Initialization is 4", "0 to 3" } },
    { [](vtkDeformableSurface* f) { f->SetBorderValue(2); }, { "Border Value is 2", "0 to 1" } },
    { [](vtkDeformableSurface* f) { f->SetRecovery(-1); }, { "Recovery is -1" } },
    { [](vtkDeformableSurface* f) { f->SetMaximumNumberOfIterations(0); },
      { "Maximum Number Of Iterations" } },
    { [](vtkDeformableSurface* f) { f->SetInitializationToInputSurface(); },
      { "Input port 1", "no polygons" } },
    { [](vtkDeformableSurface* f)
      {
        vtkNew<vtkReverseSense> reverse;
        reverse->SetInputData(SphereAt({ 16, 16, 16 }, 10));
        reverse->Update();
        f->SetInitializationToInputSurface();
        f->SetInitialSurfaceData(reverse->GetOutput());
      },
      { "Input port 1", "initial surface", "inside out" } },
    { [](vtkDeformableSurface* f)
      {
        vtkNew<vtkPolyData> broken;
        broken->DeepCopy(SphereAt({ 16, 16, 16 }, 10));
        broken->GetPolys()->ReplaceCellAtId(0, { 0, 1, 1000000 });
        f->SetInitializationToInputSurface();
        f->SetInitialSurfaceData(broken);
      },
      { "Input port 1", "the data have a cell with point 1000000" } },
    { [](vtkDeformableSurface* f)
      {
        vtkNew<vtkPolyData> broken;
        broken->DeepCopy(SphereAt({ 16, 16, 16 }, 10));
        broken->SetStrips(vtkNew<vtkCellArray>());
        broken->GetStrips()->InsertNextCell(0);
        f->SetInitializationToInputSurface();
        f->SetInitialSurfaceData(broken);
      },
      { "Input port 1", "the data have strip 0 with less than 3 points" } },
    { [placed](vtkDeformableSurface* f) { f->SetInputDataObject(placed(2000.0, 0.0)); },
      { "spacing of the image is 1 x 1 x 2000", "1000 times" } },
    { [placed](vtkDeformableSurface* f) { f->SetInputDataObject(placed(1e-13, 0.0)); },
      { "1 x 1 x 1e-13", "1e-12 to 1e12" } },
    { [placed](vtkDeformableSurface* f) { f->SetInputDataObject(placed(1.0, 1e11)); },
      { "Input port 0", "more than 1e10 voxels from 0" } },
    { [placed](vtkDeformableSurface* f) { f->SetInputDataObject(placed(1.0, std::nan(""))); },
      { "more than 1e10 voxels from 0" } },
    { [](vtkDeformableSurface* f)
      {
        f->SetInitializationToSeeds();
        f->SetInitialSurfaceData(SphereAt({ 16, 16, 16 }, 10));
      },
      { "Input port 1", "vertices" } },
  };
  for (const double iso : { -5.0, 100.0, 101.0, infinite })
  {
    cases.push_back({ [iso](vtkDeformableSurface* f) { f->SetIsoValue(iso); },
      { "Iso Value is", iso == 100.0 ? "at an end of" : "outside", "the range",
        "between 0 and 100" } });
  }
  for (const double size : { 1e300, -1e300, 2e38 }) // too large for single precision
  {
    cases.push_back({ [size](vtkDeformableSurface* f)
      {
        const auto image = RandomImage(32, 32, 32, VTK_DOUBLE);
        FillBox(image, { 16, 16, 16 }, { 17, 17, 17 }, size);
        f->SetInputDataObject(image);
      },
      { "Input port 0: level", "array", "absolute values", "Scale the image" } });
  }
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.Parts.front());
    ExpectErrorOf(FilterOf(BallImage(32, 32, 32), test.Spoil), test.Parts);
  }
}

TEST_F(DeformableSurfaceErrors, NaNVoxelsInABlock)
{
  const auto blocks = this->Pyramid();
  Voxels(Level(blocks, 1))->SetComponent(2, 0, std::nan(""));
  this->Filter->SetInputDataObject(blocks);
  this->Filter->NaNIsBackgroundOff();
  this->ExpectError({ "Input port 0: level 1", "NaN", "(2, 0, 0)" });
}

TEST_F(DeformableSurfaceErrors, ReportsBlocksThatAreNotAPyramid)
{
  const std::vector<ErrorCase<vtkMultiBlockDataSet>> cases = {
    { [](vtkMultiBlockDataSet* b) { b->SetNumberOfBlocks(0); }, { "has no blocks" } },
    { [](vtkMultiBlockDataSet* b) { b->SetBlock(1, nullptr); }, { "block 1 is empty" } },
    { [](vtkMultiBlockDataSet* b) { b->SetBlock(1, vtkNew<vtkPolyData>()); },
      { "block 1 is vtkPolyData" } },
    { [](vtkMultiBlockDataSet* b) { Level(b, 1)->SetSpacing(1, 1, 1); },
      { "block 1", "length along x is 18", "block 0 is 32" } },
    { [](vtkMultiBlockDataSet* b) { Level(b, 1)->SetOrigin(0, 3, 0); },
      { "block 1", "first voxel is at 3 along y" } },
    { [](vtkMultiBlockDataSet* b)
      {
        const double turned[9] = { 0, 1, 0, -1, 0, 0, 0, 0, 1 };
        Level(b, 1)->SetDirectionMatrix(turned);
      },
      { "block 1", "direction matrix differs" } },
    { [](vtkMultiBlockDataSet* b)
      { Voxels(Level(b, 1))->SetComponent(2, 0, std::numeric_limits<double>::infinity()); },
      { "Input port 0: level 1", "1 infinite voxel", "(2, 0, 0)" } },
    { [](vtkMultiBlockDataSet* b)
      {
        Level(b, 0)->AllocateScalars(VTK_FLOAT, 3);
        Voxels(Level(b, 0))->SetName("Field");
      },
      { "Input port 0: level 0: array 'Field' has 3 components", "Selected Component" } },
    { [](vtkMultiBlockDataSet* b) { b->SetBlock(1, b->GetBlock(0)); },
      { "block 1", "32 x 32 x 32 voxels, not fewer than block 0 with 32 x 32 x 32" } },
  };
  for (const auto& test : cases)
  {
    const auto blocks = this->Pyramid();
    test.Spoil(blocks);
    this->Filter->SetInputDataObject(blocks);
    this->ExpectError(test.Parts);
  }
}

TEST_F(DeformableSurfaceErrors, RecoversFromAnError)
{
  this->Filter->SetInputDataObject(this->Pyramid()); // with field data
  this->Filter->SetSnapshotInterval(20);
  const auto expectSurface = [this]
  {
    this->Filter->Update();
    EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_GT(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_GT(this->Filter->GetSnapshots()->GetNumberOfBlocks(), 0u);
  };
  expectSurface();
  this->Filter->SetIsoValue(200.0);
  this->ExpectError({ "outside the range" });
  EXPECT_EQ(this->Filter->GetSnapshots()->GetNumberOfBlocks(), 0u);
  EXPECT_EQ(this->Filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(this->Filter->GetOutput()->GetFieldData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(this->Filter->GetHistory()->GetNumberOfColumns(), 0);
  EXPECT_EQ(this->Filter->GetLevels()->GetFieldData()->GetNumberOfArrays(), 0);
  this->Filter->SetIsoValue(50.0);
  expectSurface();
}

TEST_F(DeformableSurfaceErrors, ReportsAnErrorOnceWithoutStoppingThePipeline)
{
  this->Filter->SetIsoValue(200.0);
  const MessagesOf errors(this->Filter);
  const MessagesOf ofPipeline(this->Filter->GetExecutive());
  EXPECT_TRUE(this->Filter->GetExecutive()->Update());
  const std::string once = errors.Get();
  EXPECT_NE(once, "");
  this->Filter->Update();
  EXPECT_EQ(errors.Get(), once) << "up to date after an error, too";
  EXPECT_EQ(ofPipeline.Get(), "");
}

TEST_F(DeformableSurfaceErrors, ReportsAnErrorOfThePyramid)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(BallImage(32, 32, 32));
  pyramid->SetReductionFactor(3.0);
  this->Filter->SetInputConnection(pyramid->GetOutputPort());
  const MessagesOf ofPyramid(pyramid);
  this->ExpectError({ "Input port 0", "after an error of Image Pyramid" });
  EXPECT_TRUE(ofPyramid.Has("Reduction Factor"));
}
