// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicLabelsRepresentationProxy.h"

#include "LabelRows.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>

vtkStandardNewMacro(vtkSMVolumicLabelsRepresentationProxy);

namespace
{
std::vector<volumic::ColorCategory> CategoriesOf(const volumic::LabelRows& labels)
{
  std::vector<volumic::ColorCategory> categories;
  for (const volumic::LabelRow& row : labels.Rows)
  {
    categories.push_back({ std::to_string(row.Label), row.Name, row.Color });
  }
  return categories;
}

/** Appends those whose value is not there. */
void Complete(std::vector<volumic::ColorCategory>& categories,
  const std::vector<volumic::ColorCategory>& others)
{
  for (const volumic::ColorCategory& other : others)
  {
    const auto isSame = [&other](const volumic::ColorCategory& category)
    { return category.Value == other.Value; };
    if (std::none_of(categories.begin(), categories.end(), isSame))
    {
      categories.push_back(other);
    }
  }
}
}

//------------------------------------------------------------------------------
vtkSMVolumicLabelsRepresentationProxy::vtkSMVolumicLabelsRepresentationProxy() = default;
vtkSMVolumicLabelsRepresentationProxy::~vtkSMVolumicLabelsRepresentationProxy() = default;

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::StartPresets()
{
  this->Superclass::StartPresets();
  this->IsWaitingForLabels = true;
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  vtkPVDataInformation* data = this->IsWaitingForLabels ? this->GetInputInformation() : nullptr;
  if (data && data->GetArrayInformation("Label", vtkDataObject::CELL))
  {
    this->IsWaitingForLabels = false;
    this->SetScalarColoring("Label", vtkDataObject::CELL);
  }
  this->Superclass::ViewUpdated(view);
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::AdaptColorsOf(
  const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data)
{
  if (array != "Label")
  {
    this->Superclass::AdaptColorsOf(array, colors, data);
    return;
  }
  vtkSMPropertyHelper input(this, "Input", true);
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (!source || data->GetMTime() == this->AdaptedTime)
  {
    return;
  }
  const std::vector<volumic::ColorCategory> wanted =
    CategoriesOf(volumic::FetchLabelsOfSurfaces(source, input.GetOutputPort()));
  this->AdaptedTime = data->GetMTime();
  // Of an error there are none: what is there serves again.
  if (!wanted.empty())
  {
    this->GiveCategories(colors, wanted);
    this->GiveToOthers(wanted);
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::GiveCategories(
  vtkSMProxy* colors, std::vector<volumic::ColorCategory> wanted)
{
  std::vector<volumic::ColorCategory> present = volumic::CategoriesOf(colors);
  if (volumic::HasGotItsRange(colors) && !volumic::AreSame(present, this->Given))
  {
    Complete(present, wanted);
    wanted = present;
  }
  else
  {
    this->Given = wanted;
  }
  volumic::SetCategories(colors, wanted);
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::GiveToOthers(
  const std::vector<volumic::ColorCategory>& wanted)
{
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMProxy* colors =
    manager->GetColorTransferFunction("Label", this->GetSessionProxyManager());
  if (colors && (!volumic::HasGotItsRange(colors) ||
    volumic::AreSame(volumic::CategoriesOf(colors), this->GivenToOthers)))
  {
    volumic::SetCategories(colors, wanted);
    this->GivenToOthers = wanted;
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsWaitingForLabels: " << this->IsWaitingForLabels << "\n";
  os << indent << "Given: " << this->Given.size() << " categories\n";
}
