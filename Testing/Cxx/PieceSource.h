// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPieceSource_h
#define volumicPieceSource_h

#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

namespace volumic
{
/** Gives pieces of an image, or all of it to the first process, as sources of either kind do. */
class PieceSource : public vtkImageAlgorithm
{
public:
  static PieceSource* New() { VTK_STANDARD_NEW_BODY(PieceSource); }
  vtkTypeMacro(PieceSource, vtkImageAlgorithm);

  vtkSmartPointer<vtkImageData> Whole;
  bool GivesPieces = true;

protected:
  PieceSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), this->Whole->GetExtent(), 6);
    if (this->GivesPieces)
    {
      info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    }
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkImageData* piece = vtkImageData::GetData(output);
    int extent[6];
    output->GetInformationObject(0)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    piece->DeepCopy(this->Whole);
    if (extent[1] < extent[0])
    {
      piece->Initialize();
      return 1;
    }
    piece->Crop(extent);
    return 1;
  }
};
}

#endif
