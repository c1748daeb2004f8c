// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"
#include "vtkDeformableSurface.h"
#include "vtkOtsuThreshold.h"
#include "vtkVolumeToSurface.h"

#include <vtkDataObject.h>
#include <vtkImageAlgorithm.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

using namespace volumic;

namespace
{
constexpr int Side = 24;

/** Makes what it is asked for of a ball of Side^3 voxels, and keeps in mind how much that was. */
class CountingSource : public vtkImageAlgorithm
{
public:
  static CountingSource* New();
  vtkTypeMacro(CountingSource, vtkImageAlgorithm);

  vtkIdType Made = -1; ///< voxels; -1: was not asked

protected:
  CountingSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    const int whole[6] = { 0, Side - 1, 0, Side - 1, 0, Side - 1 };
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
    info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_FLOAT, 1);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    int extent[6];
    info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_GE(extent[2 * axis], 0) << "within the whole extent, or nothing";
      EXPECT_LT(extent[2 * axis], Side);
      EXPECT_GE(extent[2 * axis + 1], extent[2 * axis] - 1);
    }
    const auto whole = BallImage(Side, Side, Side);
    vtkImageData* image = vtkImageData::GetData(output);
    image->SetExtent(extent);
    image->AllocateScalars(VTK_FLOAT, 1);
    ForBox({ extent[0], extent[2], extent[4] }, { extent[1] + 1, extent[3] + 1, extent[5] + 1 },
      [&](int i, int j, int k)
      {
        image->SetScalarComponentFromDouble(
          i, j, k, 0, whole->GetScalarComponentAsDouble(i, j, k, 0));
      });
    this->Made = image->GetNumberOfPoints();
    return 1;
  }
};
vtkStandardNewMacro(CountingSource);

/** What the source made for one of two processes. */
vtkIdType VoxelsFor(vtkAlgorithm* filter, int process)
{
  vtkNew<CountingSource> source;
  filter->SetInputConnection(source->GetOutputPort());
  const MessagesOf errors(filter);
  filter->UpdatePiece(process, 2, 0);
  EXPECT_EQ(errors.Get(), "");
  return source->Made;
}
}

TEST(ParallelRequests, OnlyTheProcessThatWorksHoldsTheImage)
{
  vtkNew<vtkImagePyramid> pyramid;
  vtkNew<vtkDeformableSurface> surface;
  surface->SetIsoValue(50.0);
  vtkNew<vtkVolumeToSurface> volumeToSurface;
  vtkNew<vtkOtsuThreshold> otsu;
  const std::vector<vtkAlgorithm*> filters = { pyramid, surface, volumeToSurface, otsu };
  for (vtkAlgorithm* filter : filters)
  {
    SCOPED_TRACE(filter->GetClassName());
    EXPECT_EQ(VoxelsFor(filter, 0), Side * Side * Side) << "all for the one that works";
    EXPECT_LE(VoxelsFor(filter, 1), 0) << "none for the other";
  }
}

TEST(ParallelRequests, OnlyTheProcessThatWorksHasAnOutput)
{
  vtkNew<CountingSource> source;
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkDeformableSurface> surface;
  surface->SetInputConnection(pyramid->GetOutputPort());
  surface->SetIsoValue(50.0);
  surface->UpdatePiece(1, 2, 0);
  EXPECT_EQ(surface->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_LE(source->Made, 0);
  surface->UpdatePiece(0, 2, 0);
  EXPECT_GT(surface->GetOutput()->GetNumberOfPoints(), 100);
  EXPECT_EQ(source->Made, Side * Side * Side);
}
