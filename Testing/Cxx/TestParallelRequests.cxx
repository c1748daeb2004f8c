// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "vtkLabelTable.h"
#include "vtkLabelsToSurfaces.h"
#include "vtkOtsuThreshold.h"
#include "vtkVolumeToSurface.h"

#include <vtkImageAlgorithm.h>
#include <vtkImageShiftScale.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkResampleToImage.h>
#include <vtkStreamingDemandDrivenPipeline.h>

using namespace volumic;

namespace
{
constexpr int Side = 24;
constexpr std::array<int, 6> WholeExtent = { 0, Side - 1, 0, Side - 1, 0, Side - 1 };

/** A source that computes the requested part of a ball, and counts its voxels. */
class CountingSource : public vtkImageAlgorithm
{
public:
  static CountingSource* New();
  vtkTypeMacro(CountingSource, vtkImageAlgorithm);

  vtkIdType Made = -1;        ///< voxels of the last run; -1: there was none
  bool IsDistributed = false; ///< gives no more than the lower half

protected:
  CountingSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), WholeExtent.data(), 6);
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
    extent[5] = this->IsDistributed ? std::min(extent[5], Side / 2) : extent[5];
    vtkImageData* image = vtkImageData::GetData(output);
    image->SetExtent(extent);
    image->AllocateScalars(VTK_FLOAT, 1);
    ForBox({ extent[0], extent[2], extent[4] }, { extent[1] + 1, extent[3] + 1, extent[5] + 1 },
      [&](int i, int j, int k)
      {
        const double radius = std::hypot(i - 11.5, j - 11.5, k - 11.5);
        image->SetScalarComponentFromDouble(i, j, k, 0, radius < 7.2 ? 100.0 : 0.0);
      });
    this->Made = image->GetNumberOfPoints();
    return 1;
  }
};
vtkStandardNewMacro(CountingSource);

/** All filters, with what they need to make an output of the source. */
class ParallelRequests : public testing::Test
{
protected:
  ParallelRequests()
  {
    this->Surface->SetIsoValue(50.0);
    this->VolumeToSurface->SetIsoValue(50.0);
    this->Labels->AddLabel(100);
    for (vtkAlgorithm* filter : this->Filters)
    {
      filter->SetInputConnection(this->Source->GetOutputPort());
    }
  }

  vtkNew<CountingSource> Source;
  vtkNew<vtkImagePyramid> Pyramid;
  vtkNew<vtkDeformableSurface> Surface;
  vtkNew<vtkVolumeToSurface> VolumeToSurface;
  vtkNew<vtkLabelsToSurfaces> Labels;
  vtkNew<vtkLabelTable> Table;
  vtkNew<vtkOtsuThreshold> Otsu;
  const std::vector<vtkAlgorithm*> Filters = { this->Pyramid, this->Surface, this->VolumeToSurface,
    this->Labels, this->Table, this->Otsu };
};

/** Check that the blocks of another process have the same names, and are null. */
void ExpectSameBlocks(vtkAlgorithm* filter, int port)
{
  filter->UpdatePiece(1, 2, 0);
  vtkNew<vtkMultiBlockDataSet> other;
  other->ShallowCopy(filter->GetOutputDataObject(port));
  filter->UpdatePiece(0, 2, 0);
  auto* first = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(port));
  ASSERT_GT(first->GetNumberOfBlocks(), 0u);
  ASSERT_EQ(other->GetNumberOfBlocks(), first->GetNumberOfBlocks());
  for (unsigned int block = 0; block < first->GetNumberOfBlocks(); ++block)
  {
    EXPECT_EQ(other->GetBlock(block), nullptr);
    EXPECT_STREQ(other->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()),
      first->GetMetaData(block)->Get(vtkCompositeDataSet::NAME()));
  }
}
}

TEST_F(ParallelRequests, FirstProcessComputesTheWholeOutput)
{
  for (vtkAlgorithm* filter : this->Filters)
  {
    SCOPED_TRACE(filter->GetClassName());
    const MessagesOf errors(filter);
    this->Source->Modified();
    this->Source->Made = -1;
    filter->UpdatePiece(1, 2, 0);
    if (filter != this->Labels) // Their names are in the voxels.
    {
      EXPECT_LE(this->Source->Made, 0) << "no voxels for a process that makes nothing of them";
    }
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      vtkInformation* info = filter->GetOutputPortInformation(port);
      ASSERT_TRUE(
        filter->GetOutputDataObject(port)->IsA(info->Get(vtkDataObject::DATA_TYPE_NAME())));
      EXPECT_EQ(SizeOfOutput(filter, port), 0) << port;
    }
    this->Source->Modified(); // VTK 9.6 does not execute table filters for another piece only.
    filter->UpdatePiece(0, 2, 1);
    EXPECT_EQ(this->Source->Made, Side * Side * Side);
    EXPECT_GT(SizeOfOutput(filter, 0), 0);
    EXPECT_EQ(errors.Get(), "");
  }
}

TEST_F(ParallelRequests, ReachTheSourceThroughAPyramid)
{
  this->Surface->SetInputConnection(this->Pyramid->GetOutputPort());
  this->Surface->UpdatePiece(1, 2, 0);
  EXPECT_EQ(this->Surface->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_LE(this->Source->Made, 0);
  this->Surface->UpdatePiece(0, 2, 0);
  EXPECT_EQ(this->Source->Made, Side * Side * Side);
  this->VolumeToSurface->Update(); // by a single process
  EXPECT_GT(this->Surface->GetOutput()->GetNumberOfPoints(), 100);
  ExpectSameSurfaces(this->Surface->GetOutput(), this->VolumeToSurface->GetOutput());
}

TEST_F(ParallelRequests, HaveTheSameBlocksInAllProcesses)
{
  ExpectSameBlocks(this->Pyramid, 0);
  this->Labels->ClearLabels();
  this->Labels->SetLabelName(100, "ball");
  ExpectSameBlocks(this->Labels, 0);
  this->Labels->SetMerge(true);
  ExpectSameBlocks(this->Labels, 0);
}

TEST_F(ParallelRequests, HaveTheSameLevelsInAllProcesses)
{
  constexpr int levels = 1;
  this->VolumeToSurface->SetNumberOfLevels(2);
  this->Surface->SetFinestLevel(1);
  for (vtkDeformableSurface* filter :
    { this->Surface.Get(), static_cast<vtkDeformableSurface*>(this->VolumeToSurface.Get()) })
  {
    SCOPED_TRACE(filter->GetClassName());
    ExpectSameBlocks(filter, levels);
    filter->SetFinestLevel(-1);
    ExpectSameBlocks(filter, levels);
    filter->SetPreview(true);
    ExpectSameBlocks(filter, levels);
    filter->SetPreview(false);
    for (const double length : { 0.8, 2.0 })
    {
      filter->SetEdgeLength(length);
      ExpectSameBlocks(filter, levels);
    }
    filter->SetEdgeLength(0.0);
    filter->SetFinestLevel(0);
    filter->SetThinParts(true);
    ExpectSameBlocks(filter, levels);
  }
  this->Surface->SetInputConnection(this->Pyramid->GetOutputPort());
  ExpectSameBlocks(this->Surface, levels);
}

TEST_F(ParallelRequests, HaveTheSameBlocksAfterAnError)
{
  this->Surface->SetIsoValue(200.0);
  const MessagesOf errors(this->Surface);
  ExpectSameBlocks(this->Surface, 1);
  EXPECT_TRUE(Has(errors.Get(), "Iso Value is 200"));
  this->Pyramid->SetSelectedComponent(7);
  const MessagesOf others(this->Pyramid);
  ExpectSameBlocks(this->Pyramid, 0);
  EXPECT_NE(others.Get(), "");
}

TEST_F(ParallelRequests, AreTheSameInAllProcessesForAResampledImage)
{
  vtkNew<vtkResampleToImage> resampled; // ParaView's ends all processes where they differ.
  resampled->SetInputConnection(this->Source->GetOutputPort());
  resampled->SetSamplingDimensions(Side, Side, Side);
  vtkNew<vtkImageShiftScale> between;
  between->SetInputConnection(resampled->GetOutputPort());
  this->Surface->SetInputConnection(between->GetOutputPort());
  for (const int process : { 1, 0 })
  {
    this->Surface->UpdatePiece(process, 2, 0);
    std::array<int, 6> extent;
    resampled->GetOutputInformation(0)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent.data());
    EXPECT_EQ(extent, WholeExtent) << process;
    EXPECT_EQ(SizeOfOutput(this->Surface) > 0, process == 0);
  }
}

TEST_F(ParallelRequests, ReportDistributedSources)
{
  this->Source->IsDistributed = true;
  for (vtkAlgorithm* filter : this->Filters)
  {
    SCOPED_TRACE(filter->GetClassName());
    const MessagesOf errors(filter);
    filter->UpdatePiece(0, 2, 0);
    EXPECT_TRUE(Has(errors.Get(),
      "Input port 0: the source provides only 24 x 24 x 13 of the image's "
      "24 x 24 x 24 voxels"));
    EXPECT_TRUE(Has(errors.Get(), "Save the distributed image as .pvti"));
    EXPECT_EQ(SizeOfOutput(filter), 0);
    filter->UpdatePiece(1, 2, 0);
    EXPECT_EQ(SizeOfOutput(filter), 0);
  }
}
