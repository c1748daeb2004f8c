// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicLabelsRepresentationProxy.h"

#include <vtkCommand.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMLabelsDomain.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxyIterator.h>
#include <vtkSMProxyManager.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTransferFunctionManager.h>
#include <vtkSMViewProxy.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <set>

vtkStandardNewMacro(vtkSMVolumicLabelsRepresentationProxy);

namespace
{
/** The largest number of labels whose legend is shown automatically: more names are not readable.
 */
constexpr std::size_t MaximumInLegend = 12;

/** Add the filters Labels to Surfaces upstream of a proxy, itself included. */
void AddLabelFilters(vtkSMProxy* proxy, std::set<vtkSMProxy*>& found)
{
  if (proxy->GetXMLName() && std::strcmp(proxy->GetXMLName(), "LabelsToSurfaces") == 0)
  {
    found.insert(proxy);
    return;
  }
  for (unsigned int i = 0; i < proxy->GetNumberOfProducers(); ++i)
  {
    AddLabelFilters(proxy->GetProducerProxy(i), found);
  }
}

bool IsColoredByLabel(vtkSMPVRepresentationProxy* display)
{
  return display->GetUsingScalarColoring() &&
    std::strcmp(vtkSMPropertyHelper(display, "ColorArrayName").GetAsString(4), "Label") == 0;
}

bool HasOwnColors(vtkSMProxy* display)
{
  return vtkSMPropertyHelper(display, "UseSeparateColorMap", true).GetAsInt() != 0;
}

std::vector<volumic::ColorCategory> CategoriesOf(const volumic::LabelRows& labels)
{
  std::vector<volumic::ColorCategory> categories;
  for (const volumic::LabelRow& row : labels.Rows)
  {
    categories.push_back({ std::to_string(row.Label), row.Name, row.Color });
  }
  return categories;
}

/** Append the categories whose value is missing. */
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
void vtkSMVolumicLabelsRepresentationProxy::CreateVTKObjects()
{
  const bool isCreatedNow = !this->ObjectsCreated;
  this->Superclass::CreateVTKObjects();
  if (isCreatedNow && this->ObjectsCreated)
  {
    for (const vtkCommand::EventIds event :
      { vtkCommand::RegisterEvent, vtkCommand::PropertyModifiedEvent })
    {
      this->GetSessionProxyManager()->AddObserver(
        event, this, &vtkSMVolumicLabelsRepresentationProxy::OnSessionModified);
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::OnSessionModified(
  vtkObject*, unsigned long event, void* data)
{
  const char* name = event == vtkCommand::PropertyModifiedEvent
    ? static_cast<vtkSMProxyManager::ModifiedPropertyInformation*>(data)->PropertyName
    : "Representations";
  for (const char* relevant : { "Input", "LookupTable", "Representations" })
  {
    if (std::strcmp(name, relevant) == 0)
    {
      this->ShareColors();
    }
  }
}

//------------------------------------------------------------------------------
vtkSMProxy* vtkSMVolumicLabelsRepresentationProxy::FindLabelColors()
{
  const std::string name =
    std::string("Separate_") + this->GetGlobalIDAsString() + "_Label.PVLookupTable";
  return this->GetSessionProxyManager()->GetProxy("lookup_tables", name.c_str());
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::ShareColors()
{
  vtkSMProxy* own = this->FindLabelColors();
  vtkSMProxy* source = vtkSMPropertyHelper(this, "Input", true).GetAsProxy();
  if (!own || !source)
  {
    return;
  }
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMSessionProxyManager* session = this->GetSessionProxyManager();
  vtkSMViewProxy* view = vtkSMViewProxy::FindView(this);
  vtkSMProxy* common = manager->GetColorTransferFunction("Label", session);
  vtkNew<vtkSMProxyIterator> displays;
  displays->SetSessionProxyManager(session);
  displays->SetModeToOneGroup();
  for (displays->Begin("representations"); !displays->IsAtEnd(); displays->Next())
  {
    auto* display = vtkSMPVRepresentationProxy::SafeDownCast(displays->GetProxy());
    if (!display || !IsColoredByLabel(display) || (display != this && HasOwnColors(display)))
    {
      continue;
    }
    std::set<vtkSMProxy*> filters;
    AddLabelFilters(display, filters);
    vtkSMProxy* present = vtkSMPropertyHelper(display, "LookupTable").GetAsProxy();
    // The labels of two maps in one dataset cannot be distinguished.
    const bool isOfThis = filters == std::set<vtkSMProxy*>{ source };
    vtkSMProxy* assigned = present;
    if (isOfThis && (present == common || (view && view == vtkSMViewProxy::FindView(display))))
    {
      assigned = own;
    }
    else if (!isOfThis && present == own)
    {
      assigned = common;
    }
    if (assigned != present)
    {
      vtkSMPropertyHelper(display, "LookupTable").Set(assigned);
      vtkSMPropertyHelper(display, "ScalarOpacityFunction", true)
        .Set(vtkSMPropertyHelper(assigned, "ScalarOpacityFunction").GetAsProxy());
      display->UpdateVTKObjects();
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  // The superclass updates the data information.
  this->Superclass::ViewUpdated(view);
  vtkSMProxy* source = vtkSMPropertyHelper(this, "Input", true).GetAsProxy();
  vtkPVDataInformation* data = this->GetInputInformation();
  if (!source || !data)
  {
    return;
  }
  if (!this->IsFollowing)
  {
    // A hidden display is not updated with the view.
    source->AddObserver(
      vtkCommand::UpdateDataEvent, this, &vtkSMVolumicLabelsRepresentationProxy::FollowData);
    this->IsFollowing = true;
  }
  if (this->IsNew && data->GetArrayInformation("Label", vtkDataObject::CELL))
  {
    this->IsNew = false;
    vtkSMProxy* common = vtkSMPropertyHelper(this, "LookupTable").GetAsProxy();
    this->SetScalarColoring("Label", vtkDataObject::CELL);
    this->FollowData();
    vtkNew<vtkSMTransferFunctionManager> manager;
    manager->HideScalarBarIfNotNeeded(common, view);
    this->ShowLegend(view);
  }
  this->FollowData();
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::FollowData()
{
  vtkSMProxy* colors = this->FindLabelColors();
  vtkPVDataInformation* data = this->GetInputInformation();
  if (!colors || !data)
  {
    return;
  }
  this->AdaptColorsOf("Label", colors, data);
  vtkSMProxy* view = vtkSMViewProxy::FindView(this);
  if (view && this->CountInLegend > 0 && IsColoredByLabel(this) &&
    (this->Count <= MaximumInLegend) != (this->CountInLegend <= MaximumInLegend))
  {
    this->ShowLegend(view);
  }
  this->CountInLegend = this->Count;
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::ShowLegend(vtkSMProxy* view)
{
  // A legend that was shown and hidden stays hidden when the display is shown again.
  this->SetScalarBarVisibility(view, true);
  vtkNew<vtkSMTransferFunctionManager> manager;
  vtkSMProxy* bar = manager->GetScalarBarRepresentation(
    vtkSMPropertyHelper(this, "LookupTable").GetAsProxy(), view);
  const std::size_t count = std::min(this->Count, MaximumInLegend);
  vtkSMPropertyHelper(bar, "ScalarBarLength").Set(std::max(0.33, 0.04 * count));
  bar->UpdateVTKObjects();
  if (this->Count > MaximumInLegend)
  {
    this->SetScalarBarVisibility(view, false);
  }
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
  vtkSMPropertyHelper input(this, "Input");
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  // ParaView sets the common colour map at first.
  if (data->GetMTime() == this->AdaptedTime || colors != this->FindLabelColors())
  {
    return;
  }
  this->AdaptedTime = data->GetMTime();
  std::vector<volumic::ColorCategory> categories =
    CategoriesOf(vtkSMLabelsDomain::FetchLabels(source, input.GetOutputPort()));
  if (categories.empty())
  {
    return; // After an error keep the categories of the previous run.
  }
  this->Count = categories.size();
  std::vector<volumic::ColorCategory> present = volumic::CategoriesOf(colors);
  if (volumic::IsInitialized(colors) && !volumic::AreSame(present, this->Given))
  {
    Complete(present, categories);
    categories = present;
  }
  else
  {
    this->Given = categories;
  }
  volumic::SetCategories(colors, categories);
}

//------------------------------------------------------------------------------
void vtkSMVolumicLabelsRepresentationProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Given: " << this->Given.size() << " categories\n";
}
