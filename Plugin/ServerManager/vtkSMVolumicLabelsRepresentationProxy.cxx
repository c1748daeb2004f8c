// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicLabelsRepresentationProxy.h"

#include "LabelRows.h"

#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

vtkStandardNewMacro(vtkSMVolumicLabelsRepresentationProxy);

namespace
{
/** Labels of which the legend is shown by itself: as many as can be read. */
constexpr std::size_t MostInLegend = 12;

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
void vtkSMVolumicLabelsRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  // Before this, what is known of the data is that of the run before.
  this->Superclass::ViewUpdated(view);
  if (vtkPVDataInformation* data = this->GetInputInformation())
  {
    this->ChooseLabels(data, view);
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::FetchCategories(vtkPVDataInformation* data)
{
  vtkSMPropertyHelper input(this, "Input", true);
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (source && data->GetMTime() != this->WantedTime)
  {
    this->Wanted = CategoriesOf(volumic::FetchLabelsOfSurfaces(source, input.GetOutputPort()));
    this->WantedTime = data->GetMTime();
  }
}

//------------------------------------------------------------------------------
bool vtkSMVolumicLabelsRepresentationProxy::IsMerged(vtkPVDataInformation* data)
{
  this->FetchCategories(data);
  vtkDataAssembly* hierarchy = data->GetHierarchy();
  return hierarchy && this->Wanted.size() >
    hierarchy->GetChildNodes(vtkDataAssembly::GetRootNode(), false).size();
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::ChooseLabels(
  vtkPVDataInformation* data, vtkSMProxy* view)
{
  vtkSMPropertyHelper array(this, "ColorArrayName");
  const bool isByBlock = array.GetInputArrayNameToProcess() &&
    std::strcmp(array.GetInputArrayNameToProcess(), "Label") == 0 &&
    array.GetInputArrayAssociation() == vtkDataObject::FIELD;
  if (!data->GetArrayInformation("Label", vtkDataObject::CELL) ||
    !(this->IsNew || isByBlock))
  {
    return;
  }
  const bool isMerged = this->IsMerged(data);
  if (this->IsNew || isMerged)
  {
    this->SetScalarColoring("Label", isMerged ? vtkDataObject::CELL : vtkDataObject::FIELD);
  }
  if (this->IsNew && this->Wanted.size() <= MostInLegend)
  {
    this->SetScalarBarVisibility(view, true);
  }
  this->IsNew = false;
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
  this->FetchCategories(data);
  // Of an error there are none: what is there serves again.
  if (this->WantedTime != this->AdaptedTime && !this->Wanted.empty())
  {
    this->GiveCategories(colors, this->Wanted);
    this->GiveToOthers(this->Wanted);
  }
  this->AdaptedTime = this->WantedTime;
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
  os << indent << "Given: " << this->Given.size() << " categories\n";
}
