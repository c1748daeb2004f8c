// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"
#include "vtkOtsuThreshold.h"
#include "vtkVolumeToSurface.h"

#include <vtkExecutive.h>
#include <vtkOverlappingAMR.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

using namespace volumic;

namespace
{
/** Update a filter with an input, and return its only error. */
std::string ErrorOf(vtkAlgorithm* filter, vtkDataObject* input)
{
  filter->SetInputDataObject(input);
  const MessagesOf errors(filter);
  const MessagesOf ofExecutive(filter->GetExecutive());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);
  EXPECT_EQ(ofExecutive.Get(), "");
  const std::string text = errors.Get();
  EXPECT_EQ(text.find("ERROR:"), text.rfind("ERROR:")) << text;
  return text;
}

std::vector<vtkSmartPointer<vtkDataObject>> UnevenGrids()
{
  vtkNew<vtkUnstructuredGrid> nested;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, nested);
  return { vtkSmartPointer<vtkOverlappingAMR>::New(), vtkSmartPointer<vtkRectilinearGrid>::New(),
    vtkSmartPointer<vtkStructuredGrid>::New(), vtkSmartPointer<vtkUnstructuredGrid>::New(),
    blocks };
}

std::vector<vtkSmartPointer<vtkAlgorithm>> AllFilters()
{
  return { vtkSmartPointer<vtkImagePyramid>::New(), vtkSmartPointer<vtkDeformableSurface>::New(),
    vtkSmartPointer<vtkVolumeToSurface>::New(), vtkSmartPointer<vtkOtsuThreshold>::New() };
}

/** Composite datasets whose only image is this. */
std::vector<vtkSmartPointer<vtkDataObject>> HoldersOf(vtkImageData* image)
{
  vtkNew<vtkPolyData> other;
  vtkNew<vtkMultiBlockDataSet> inner;
  inner->SetBlock(2, image);
  vtkNew<vtkMultiBlockDataSet> outer;
  outer->SetBlock(0, other);
  outer->SetBlock(1, inner);
  vtkNew<vtkPartitionedDataSet> partitions;
  partitions->SetPartition(0, image);
  vtkNew<vtkPartitionedDataSetCollection> collection;
  collection->SetPartitionedDataSet(0, partitions);
  return { outer, partitions, collection };
}
}

TEST(InputImage, ReportsGridsOfOtherTypesOnce)
{
  for (const auto& filter : AllFilters())
  {
    for (const auto& grid : UnevenGrids())
    {
      if (filter->IsA("vtkDeformableSurface") && !filter->IsA("vtkVolumeToSurface") &&
        grid->IsA("vtkMultiBlockDataSet"))
      {
        continue; // Its blocks should be levels.
      }
      SCOPED_TRACE(std::string(filter->GetClassName()) + " " + grid->GetClassName());
      const std::string error = ErrorOf(filter, grid);
      const char* type =
        grid->IsA("vtkMultiBlockDataSet") ? "vtkUnstructuredGrid" : grid->GetClassName();
      EXPECT_TRUE(Has(error, std::string("Input port 0: the input is a ") + type));
      EXPECT_TRUE(Has(error, "Resample To Image"));
    }
  }
}

TEST(InputImage, UsesTheOnlyImageOfACompositeDataset)
{
  const auto image = BallImage(40, 40, 40);
  const auto requested = Updated<vtkVolumeToSurface>(image);
  for (const auto& holder : HoldersOf(image))
  {
    SCOPED_TRACE(holder->GetClassName());
    const auto filter = Updated<vtkVolumeToSurface>(holder);
    ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.5);
    EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), requested->GetOutput()));
    const auto pyramid = Updated<vtkImagePyramid>(holder);
    ASSERT_GT(pyramid->GetOutput()->GetNumberOfBlocks(), 1u);
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 0)), Voxels(image));
  }
}

TEST(InputImage, ReportsSeveralImages)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, BallImage(24, 24, 24));
  blocks->SetBlock(1, BallImage(24, 24, 24));
  for (const auto& filter : AllFilters())
  {
    SCOPED_TRACE(filter->GetClassName());
    const std::string error = ErrorOf(filter, blocks);
    const bool wantsLevels =
      filter->IsA("vtkDeformableSurface") && !filter->IsA("vtkVolumeToSurface");
    EXPECT_TRUE(Has(error, wantsLevels ? "is not a level of a pyramid" : "has 2 images"));
  }
}

TEST(SelectedComponent, OfAllTypes)
{
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_INT, VTK_FLOAT, VTK_DOUBLE })
  {
    vtkNew<vtkImageData> image;
    image->SetDimensions(12, 12, 12);
    image->AllocateScalars(type, 2);
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      Voxels(image)->SetComponent(i, 0, 3);
      Voxels(image)->SetComponent(i, 1, 4);
    }
    const auto pyramid = PyramidOf(image, 1);
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 0))->GetComponent(7, 0), 5.0) << type;
    pyramid->SetSelectedComponent(1);
    pyramid->Update();
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 0))->GetComponent(7, 0), 4.0) << type;
    EXPECT_EQ(Voxels(Level(pyramid->GetOutput(), 0))->GetDataType(), type);
  }
}
