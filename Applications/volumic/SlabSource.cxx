// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabReader.h"

#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <array>
#include <exception>
#include <utility>

namespace tool
{
namespace
{
class SlabSource : public vtkImageAlgorithm
{
public:
  static SlabSource* New();
  vtkTypeMacro(SlabSource, vtkImageAlgorithm);

  std::unique_ptr<SlabReader> Reader;

protected:
  SlabSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    const std::array<int, 3>& size = this->Reader->Size;
    const int whole[6] = { 0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1 };
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole, 6);
    info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
    vtkDataObject::SetPointDataActiveScalarInfo(
      info, this->Reader->Type, this->Reader->Components);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override
  {
    vtkInformation* info = output->GetInformationObject(0);
    int extent[6];
    info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    try
    {
      // Slices are whole, whatever part of them is asked for.
      const std::array<int, 3>& size = this->Reader->Size;
      const vtkSmartPointer<vtkDataArray> values =
        this->Reader->Read(extent[4], extent[5] - extent[4] + 1);
      vtkImageData* image = vtkImageData::GetData(info);
      image->SetExtent(0, size[0] - 1, 0, size[1] - 1, extent[4], extent[5]);
      PlaceImage(image, this->Reader->Placement);
      const std::string& name = this->Reader->ArrayName;
      values->SetName(name.empty() ? "Intensity" : name.c_str());
      image->GetPointData()->SetScalars(values);
      if (!this->Reader->WorldAxes.empty())
      {
        SetWorldAxes(image, this->Reader->WorldAxes);
      }
      return 1;
    }
    catch (const std::exception& error)
    {
      vtkErrorMacro(<< error.what());
      return 0;
    }
  }
};

vtkStandardNewMacro(SlabSource);
}

vtkSmartPointer<vtkAlgorithm> NewSlabSource(std::unique_ptr<SlabReader> reader)
{
  auto source = vtkSmartPointer<SlabSource>::New();
  source->Reader = std::move(reader);
  return source;
}
}
