// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMPyramidLevelsDomain.h"

#include "vtkImagePyramid.h"

#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <string>

vtkStandardNewMacro(vtkSMPyramidLevelsDomain);

//------------------------------------------------------------------------------
vtkSMPyramidLevelsDomain::vtkSMPyramidLevelsDomain()
  : First(0)
  , LastWithoutInput(0)
{
}

vtkSMPyramidLevelsDomain::~vtkSMPyramidLevelsDomain() = default;

//------------------------------------------------------------------------------
int vtkSMPyramidLevelsDomain::ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element)
{
  if (!this->Superclass::ReadXMLAttributes(property, element))
  {
    return 0;
  }
  this->First = this->GetMinimum(0);
  this->LastWithoutInput = this->GetMaximum(0);
  return 1;
}

//------------------------------------------------------------------------------
void vtkSMPyramidLevelsDomain::Update(vtkSMProperty*)
{
  int levels = 0;
  if (vtkSMProperty* input = this->GetRequiredProperty("Input"))
  {
    vtkSMUncheckedPropertyHelper source(input);
    auto* producer = vtkSMSourceProxy::SafeDownCast(
      source.GetNumberOfElements() > 0 ? source.GetAsProxy() : nullptr);
    if (producer)
    {
      levels = this->CountLevels(producer->GetDataInformation(source.GetOutputPort()));
    }
  }
  this->SetEntries({ vtkEntry(this->First, levels > 0 ? levels - 1 : this->LastWithoutInput) });
}

//------------------------------------------------------------------------------
int vtkSMPyramidLevelsDomain::CountLevels(vtkPVDataInformation* data)
{
  if (!data)
  {
    return 0;
  }
  if (data->IsCompositeDataSet())
  {
    vtkDataAssembly* blocks = data->GetHierarchy();
    return blocks ? blocks->GetNumberOfChildren(vtkDataAssembly::GetRootNode()) : 0;
  }
  return data->DataSetTypeIsA("vtkImageData") ? this->CountLevelsOfImage(data->GetExtent()) : 0;
}

//------------------------------------------------------------------------------
int vtkSMPyramidLevelsDomain::CountLevelsOfImage(const int extent[6])
{
  vtkNew<vtkImagePyramid> pyramid;
  if (vtkSMProperty* number = this->GetRequiredProperty("NumberOfLevels"))
  {
    pyramid->SetNumberOfLevels(vtkSMUncheckedPropertyHelper(number).GetAsInt());
  }
  if (vtkSMProperty* minimum = this->GetRequiredProperty("MinimumLevelSize"))
  {
    pyramid->SetMinimumLevelSize(vtkSMUncheckedPropertyHelper(minimum).GetAsInt());
  }
  if (vtkSMProperty* factor = this->GetRequiredProperty("ReductionFactor"))
  {
    pyramid->SetReductionFactor(vtkSMUncheckedPropertyHelper(factor).GetAsDouble());
  }
  bool ofCells = false;
  if (vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection"))
  {
    vtkSMUncheckedPropertyHelper chosen(selection);
    ofCells = chosen.GetNumberOfElements() > 3 &&
      chosen.GetAsString(3) == std::to_string(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  }
  const int more = ofCells ? 0 : 1;
  return pyramid->CountLevels(extent[1] - extent[0] + more, extent[3] - extent[2] + more,
    extent[5] - extent[4] + more);
}

//------------------------------------------------------------------------------
int vtkSMPyramidLevelsDomain::SetDefaultValues(vtkSMProperty*, bool)
{
  return 0;
}

//------------------------------------------------------------------------------
void vtkSMPyramidLevelsDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "First: " << this->First << endl;
  os << indent << "LastWithoutInput: " << this->LastWithoutInput << endl;
}
