// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"

#include <vtkCellData.h>
#include <vtkExecutive.h>
#include <vtkFloatArray.h>
#include <vtkStringArray.h>

using namespace volumic;

namespace
{
class ImagePyramidErrors : public ::testing::Test
{
protected:
  void ExpectError(vtkImageData* image, const std::vector<std::string>& parts)
  {
    this->Filter->SetInputDataObject(image);
    ExpectErrorOf(this->Filter, parts);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 0u) << "no output half made";
  }

  vtkNew<vtkImagePyramid> Filter;
};
}

TEST_F(ImagePyramidErrors, NoInput)
{
  const MessagesOf errors(this->Filter->GetExecutive());
  this->Filter->Update();
  EXPECT_TRUE(errors.Has("Input port 0")) << errors.Get();
  EXPECT_TRUE(errors.Has("has 0 connections")) << errors.Get();
}

TEST_F(ImagePyramidErrors, ReportsInvalidImages)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  vtkNew<vtkImageData> withoutArray;
  withoutArray->SetDimensions(20, 20, 20);
  const auto spoilt = [](const std::function<void(vtkImageData*, vtkDataArray*)>& spoil)
  {
    auto image = RandomImage(20, 30, 40);
    spoil(image, Voxels(image));
    return image;
  };
  const std::vector<std::pair<vtkSmartPointer<vtkImageData>, std::vector<std::string>>> cases = {
    { vtkSmartPointer<vtkImageData>::New(), { "Input port 0", "empty", "0 x 0 x 0" } },
    { withoutArray.Get(), { "no active point scalars", "no point data" } },
    { spoilt([](vtkImageData* image, vtkDataArray*)
        { image->GetPointData()->SetActiveScalars(nullptr); }),
      { "no active point scalars", "'Voxels'", "SetInputArrayToProcess" } },
    { spoilt([](vtkImageData*, vtkDataArray* voxels) { voxels->SetNumberOfTuples(7999); }),
      { "'Voxels'", "7999 values", "20 x 30 x 40" } },
    { spoilt([=](vtkImageData*, vtkDataArray* voxels) { voxels->Fill(nan); }),
      { "all voxels of array 'Voxels' are NaN or blanked" } },
  };
  for (const auto& [image, parts] : cases)
  {
    this->ExpectError(image, parts);
  }
  this->Filter->NaNIsBackgroundOff();
  this->ExpectError(spoilt([=](vtkImageData*, vtkDataArray* voxels)
                      { voxels->SetComponent((12 * 30 + 7) * 20 + 3, 0, nan); }),
    { "'Voxels' has 1 NaN voxel, the first at (3, 7, 12)", "Switch NaN Is Background on" });
  this->Filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Density");
  this->ExpectError(RandomImage(20, 20, 20), { "no point array 'Density'", "'Voxels'" });
  vtkNew<vtkStringArray> strings;
  strings->SetName("Density");
  strings->SetNumberOfValues(24000);
  this->ExpectError(
    spoilt([&](vtkImageData* image, vtkDataArray*) { image->GetPointData()->AddArray(strings); }),
    { "'Density'", "string", "'Voxels'" });
}

TEST_F(ImagePyramidErrors, ReportsCellData)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(5, 5, 5);
  vtkNew<vtkFloatArray> cells;
  cells->SetName("Density");
  cells->SetNumberOfTuples(64);
  image->GetCellData()->SetScalars(cells);
  this->ExpectError(image, { "no active point scalars", "Cell Data to Point Data" });
  this->Filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Density");
  this->ExpectError(image, { "'Density'", "not point data", "Cell Data to Point Data" });
}

TEST_F(ImagePyramidErrors, ReportsAnInvalidComponent)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(20, 20, 20);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  image->GetPointData()->GetScalars()->SetName("Colour");
  for (const int component : { -2, 3 })
  {
    this->Filter->SetSelectedComponent(component);
    this->ExpectError(image,
      { "Selected Component is " + std::to_string(component), "'Colour' has 3 components",
        "0 to 2" });
  }
  this->Filter->SetSelectedComponent(1);
  this->ExpectError(
    RandomImage(20, 20, 20), { "Selected Component is 1", "1 component. Set it to 0 or -1" });
}

TEST_F(ImagePyramidErrors, InfiniteVoxelsAreCountedAndTheFirstIsNamed)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto image = RandomImage(20, 30, 40, type);
    image->SetExtent(100, 119, 0, 29, -5, 34);
    vtkDataArray* voxels = image->GetPointData()->GetScalars();
    voxels->SetComponent(3, 0, std::numeric_limits<double>::quiet_NaN());
    voxels->SetComponent((12 * 30 + 7) * 20 + 3, 0, std::numeric_limits<double>::infinity());
    voxels->SetComponent((39 * 30 + 1) * 20, 0, -std::numeric_limits<double>::infinity());
    this->ExpectError(image, { "'Voxels'", "2 infinite voxels", "the first at (103, 7, 7)" });
  }
}

TEST_F(ImagePyramidErrors, AnErrorLeavesNoOldOutputAndNoFieldDataOfTheInput)
{
  const auto image = RandomImage(20, 20, 20);
  vtkNew<vtkFloatArray> field;
  field->SetName("Exposure");
  image->GetFieldData()->AddArray(field);
  this->Filter->SetInputDataObject(image);
  this->Filter->SetNumberOfLevels(2);
  this->Filter->Update();
  ASSERT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 2u);
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
  this->Filter->SetNumberOfLevels(12);
  this->ExpectError(image, { "Number Of Levels is 12", "20 x 20 x 20", "at most 5 levels" });
  EXPECT_EQ(this->Filter->GetOutput()->GetFieldData()->GetNumberOfArrays(), 0);
}

TEST_F(ImagePyramidErrors, MemoryThatEndsWhileALevelIsMade)
{
  this->Filter->SetNumberOfLevels(2);
  this->Filter->SetInputDataObject(RandomImage(256, 256, 200, VTK_UNSIGNED_CHAR));
  ExpectErrorWithoutMemory(
    this->Filter, "Level 1 of 1", "not enough memory for the pyramid of an image of 256 x 256");
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfBlocks(), 0u);
}
