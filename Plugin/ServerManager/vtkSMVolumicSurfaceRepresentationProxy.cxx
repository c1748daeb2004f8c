// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicSurfaceRepresentationProxy.h"

#include <vtkCommand.h>
#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkObjectFactory.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMInputArrayDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMVolumicSurfaceRepresentationProxy);

namespace
{
/** Of the components, by size; easy to tell apart, and apart from the grey of the others. */
constexpr std::array<std::array<double, 3>, 20> ComponentColors = { {
  { 0.89, 0.85, 0.76 }, { 0.12, 0.47, 0.71 }, { 1.00, 0.50, 0.05 }, { 0.17, 0.63, 0.17 },
  { 0.84, 0.15, 0.16 }, { 0.58, 0.40, 0.74 }, { 0.55, 0.34, 0.29 }, { 0.89, 0.47, 0.76 },
  { 0.74, 0.74, 0.13 }, { 0.09, 0.75, 0.81 }, { 0.68, 0.78, 0.91 }, { 1.00, 0.73, 0.47 },
  { 0.60, 0.87, 0.54 }, { 1.00, 0.60, 0.59 }, { 0.77, 0.69, 0.84 }, { 0.77, 0.61, 0.58 },
  { 0.97, 0.71, 0.82 }, { 0.86, 0.86, 0.55 }, { 0.62, 0.85, 0.90 }, { 0.20, 0.20, 0.55 },
} };

/**
 * Its setter isn't public, since others read it from XML only: the input's domain is one of many
 * of a proxy inside ParaView's own display, which XML can't replace.
 */
struct InputArrayDomain : vtkSMInputArrayDomain
{
  static void LeaveOutFieldData(vtkSMInputArrayDomain* domain)
  {
    void (vtkSMInputArrayDomain::*set)(int) = &InputArrayDomain::SetAttributeType;
    (domain->*set)(vtkSMInputArrayDomain::ANY_EXCEPT_FIELD);
  }
};

void SetNumbers(vtkSMProxy* proxy, const char* name, const std::vector<double>& values)
{
  vtkSMPropertyHelper(proxy, name, true)
    .Set(values.data(), static_cast<unsigned int>(values.size()));
}

bool HasGotItsRange(vtkSMProxy* colors)
{
  return vtkSMPropertyHelper(colors, "ScalarRangeInitialized", true).GetAsInt() != 0;
}

/** ParaView shall neither rescale it at Apply nor look for values by itself. */
void SetReady(vtkSMProxy* colors)
{
  vtkSMPropertyHelper(colors, "AutomaticRescaleRangeMode", true)
    .Set(static_cast<int>(vtkSMTransferFunctionManager::NEVER));
  vtkSMPropertyHelper(colors, "ScalarRangeInitialized", true).Set(1);
  colors->UpdateVTKObjects();
}

std::string SelectorOf(const char* label)
{
  return std::string("/Root/*[@label='") + label + "']";
}

/** The number of values that the map of components tells apart. */
int CountAnnotations(vtkSMProxy* colors)
{
  vtkSMPropertyHelper annotations(colors, "Annotations", true);
  return static_cast<int>(annotations.GetNumberOfElements() / 2);
}
}

//------------------------------------------------------------------------------
vtkSMVolumicSurfaceRepresentationProxy::vtkSMVolumicSurfaceRepresentationProxy() = default;
vtkSMVolumicSurfaceRepresentationProxy::~vtkSMVolumicSurfaceRepresentationProxy() = default;

//------------------------------------------------------------------------------
int vtkSMVolumicSurfaceRepresentationProxy::ReadXMLAttributes(
  vtkSMSessionProxyManager* manager, vtkPVXMLElement* element)
{
  const int succeeded = this->Superclass::ReadXMLAttributes(manager, element);
  vtkSMProxy* geometry = this->GetSubProxy("SurfaceRepresentation");
  vtkSMProperty* input = geometry ? geometry->GetProperty("Input") : nullptr;
  auto* domain = vtkSMInputArrayDomain::SafeDownCast(
    input ? input->GetDomain("input_array_any") : nullptr);
  if (domain)
  {
    InputArrayDomain::LeaveOutFieldData(domain);
  }
  return succeeded;
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::CreateVTKObjects()
{
  const bool isCreatedNow = !this->ObjectsCreated;
  this->Superclass::CreateVTKObjects();
  if (isCreatedNow && this->ObjectsCreated)
  {
    this->AddObserver(vtkCommand::PropertyModifiedEvent, this,
      &vtkSMVolumicSurfaceRepresentationProxy::OnPropertyModified);
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::OnPropertyModified(
  vtkObject*, unsigned long, void* name)
{
  if (name && std::strcmp(static_cast<const char*>(name), "LookupTable") == 0)
  {
    this->AdaptColors();
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  this->AdaptColors();
  this->ChooseBlock();
}

//------------------------------------------------------------------------------
vtkPVDataInformation* vtkSMVolumicSurfaceRepresentationProxy::GetInputInformation(
  const std::string& block)
{
  vtkSMPropertyHelper input(this, "Input", true);
  auto* source = vtkSMSourceProxy::SafeDownCast(
    input.GetNumberOfElements() > 0 ? input.GetAsProxy() : nullptr);
  if (!source)
  {
    return nullptr;
  }
  return block.empty() ? source->GetDataInformation(input.GetOutputPort())
                       : source->GetSubsetDataInformation(
                           input.GetOutputPort(), block.c_str(), "Hierarchy");
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::AdaptColors()
{
  vtkSMPropertyHelper lookupTable(this, "LookupTable", true);
  vtkSMProxy* colors = lookupTable.GetNumberOfElements() > 0 ? lookupTable.GetAsProxy() : nullptr;
  // What other displays share isn't ours to change.
  if (!colors || !vtkSMPropertyHelper(this, "UseSeparateColorMap", true).GetAsInt() ||
    !this->GetUsingScalarColoring())
  {
    return;
  }
  const std::string array = vtkSMPropertyHelper(this, "ColorArrayName").GetAsString(4);
  if (array != "Residual" && array != "Component")
  {
    return;
  }
  if (vtkPVDataInformation* data = this->GetInputInformation())
  {
    array == "Residual" ? this->AdaptResidualColors(colors, data)
                        : this->AdaptComponentColors(colors, data);
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::AdaptResidualColors(
  vtkSMProxy* colors, vtkPVDataInformation* data)
{
  vtkPVArrayInformation* quantile =
    data->GetArrayInformation("ResidualQuantile", vtkDataObject::FIELD);
  double range = quantile ? quantile->GetComponentRange(0)[1] : 0.0;
  range = std::isfinite(range) && range > 0.0 ? range : 1.0;
  vtkSMPropertyHelper points(colors, "RGBPoints");
  const unsigned int size = points.GetNumberOfElements();
  const bool isOurs = size == 12 && points.GetAsDouble(0) == -this->ResidualRange &&
    points.GetAsDouble(8) == this->ResidualRange;
  if (range == this->ResidualRange || (HasGotItsRange(colors) && !isOurs))
  {
    return;
  }
  // Both ends of ParaView's own "Cool to Warm", and nothing at 0.
  SetNumbers(colors, "RGBPoints",
    { -range, 0.23, 0.30, 0.75, 0.0, 0.87, 0.87, 0.87, range, 0.71, 0.02, 0.15 });
  vtkSMPropertyHelper(colors, "ColorSpace").Set("Diverging");
  this->ResidualRange = range;
  SetReady(colors);
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::AdaptComponentColors(
  vtkSMProxy* colors, vtkPVDataInformation* data)
{
  vtkPVArrayInformation* component = data->GetArrayInformation("Component", vtkDataObject::CELL);
  if (!component)
  {
    return;
  }
  const int last = std::clamp(static_cast<int>(component->GetComponentRange(0)[1]), 0,
    static_cast<int>(ComponentColors.size()) - 1);
  const bool isOurs = CountAnnotations(colors) == this->LastComponent + 1;
  if (last == this->LastComponent || (HasGotItsRange(colors) && !isOurs))
  {
    return;
  }
  std::vector<double> shown;
  vtkSMPropertyHelper annotations(colors, "Annotations");
  annotations.SetNumberOfElements(2 * static_cast<unsigned int>(last + 1));
  for (int c = 0; c <= last; ++c)
  {
    const std::string value = std::to_string(c);
    annotations.Set(2 * static_cast<unsigned int>(c), value.c_str());
    annotations.Set(2 * static_cast<unsigned int>(c) + 1, value.c_str());
    shown.insert(shown.end(), ComponentColors[c].begin(), ComponentColors[c].end());
  }
  SetNumbers(colors, "IndexedColors", shown);
  SetNumbers(colors, "NanColor", { 0.5, 0.5, 0.5 });
  vtkSMPropertyHelper(colors, "AnnotationsInitialized", true).Set(1);
  vtkSMPropertyHelper(colors, "IndexedLookup").Set(1);
  this->LastComponent = last;
  SetReady(colors);
}

//------------------------------------------------------------------------------
std::string vtkSMVolumicSurfaceRepresentationProxy::FindBlockToShow()
{
  vtkPVXMLElement* hint =
    this->GetHints() ? this->GetHints()->FindNestedElementByName("ShownBlock") : nullptr;
  vtkPVDataInformation* data = hint ? this->GetInputInformation() : nullptr;
  vtkDataAssembly* hierarchy = data && data->IsCompositeDataSet() ? data->GetHierarchy() : nullptr;
  if (!hierarchy)
  {
    return "";
  }
  std::vector<int> blocks = hierarchy->GetChildNodes(vtkDataAssembly::GetRootNode(), false);
  const char* place = hint->GetAttribute("place");
  if (place && std::strcmp(place, "last") == 0)
  {
    std::reverse(blocks.begin(), blocks.end());
  }
  for (int block : blocks)
  {
    const std::string selector = SelectorOf(hierarchy->GetAttributeOrDefault(block, "label", ""));
    vtkPVDataInformation* ofBlock = this->GetInputInformation(selector);
    if (ofBlock && ofBlock->GetNumberOfPoints() > 0)
    {
      return selector;
    }
  }
  return "";
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::StartChoosingBlock()
{
  this->IsChoosingBlock = true;
  this->ChooseBlock();
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::ChooseBlock()
{
  vtkSMPropertyHelper selectors(this, "BlockSelectors", true);
  // Other blocks than those chosen here, or given by ParaView, are the user's choice.
  const std::string given = this->ChosenBlock.empty() ? "/" : this->ChosenBlock;
  if (!this->IsChoosingBlock || selectors.GetNumberOfElements() != 1 ||
    selectors.GetAsString(0) != given)
  {
    return;
  }
  const std::string block = this->FindBlockToShow();
  if (!block.empty() && block != this->ChosenBlock)
  {
    this->ChosenBlock = block;
    selectors.Set(0, block.c_str());
    this->UpdateVTKObjects();
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ResidualRange: " << this->ResidualRange << "\n";
  os << indent << "LastComponent: " << this->LastComponent << "\n";
  os << indent << "ChosenBlock: " << this->ChosenBlock << "\n";
}
