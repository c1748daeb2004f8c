// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicSurfaceRepresentationProxy.h"

#include "ColorMaps.h"

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

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMVolumicSurfaceRepresentationProxy);

namespace
{
/** Colours of the largest components, by size. */
constexpr std::array<std::array<double, 3>, 10> ComponentColors = { {
  { 0.89, 0.85, 0.76 },
  { 0.12, 0.47, 0.71 },
  { 1.00, 0.50, 0.05 },
  { 0.17, 0.63, 0.17 },
  { 0.84, 0.15, 0.16 },
  { 0.58, 0.40, 0.74 },
  { 0.55, 0.34, 0.29 },
  { 0.89, 0.47, 0.76 },
  { 0.74, 0.74, 0.13 },
  { 0.09, 0.75, 0.81 },
} };

/**
 * Gives access to a protected setter. The domain belongs to a subproxy of ParaView's display, which
 * XML cannot replace.
 */
struct InputArrayDomain : vtkSMInputArrayDomain
{
  static void LeaveOutFieldData(vtkSMInputArrayDomain* domain)
  {
    void (vtkSMInputArrayDomain::*set)(int) = &InputArrayDomain::SetAttributeType;
    (domain->*set)(vtkSMInputArrayDomain::ANY_EXCEPT_FIELD);
  }
};

std::string SelectorOf(const char* label)
{
  return std::string("/Root/*[@label='") + label + "']";
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
  auto* domain =
    vtkSMInputArrayDomain::SafeDownCast(input ? input->GetDomain("input_array_any") : nullptr);
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
    if (this->IsNew)
    {
      vtkSMPropertyHelper(this, "UseSeparateColorMap", true).Set(1);
    }
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
int vtkSMVolumicSurfaceRepresentationProxy::LoadXMLState(
  vtkPVXMLElement* element, vtkSMProxyLocator* locator)
{
  this->IsNew = false;
  return this->Superclass::LoadXMLState(element, locator);
}

//------------------------------------------------------------------------------
vtkPVDataInformation* vtkSMVolumicSurfaceRepresentationProxy::GetInputInformation(
  const std::string& block)
{
  vtkSMPropertyHelper input(this, "Input", true);
  auto* source =
    vtkSMSourceProxy::SafeDownCast(input.GetNumberOfElements() > 0 ? input.GetAsProxy() : nullptr);
  if (!source)
  {
    return nullptr;
  }
  return block.empty()
    ? source->GetDataInformation(input.GetOutputPort())
    : source->GetSubsetDataInformation(input.GetOutputPort(), block.c_str(), "Hierarchy");
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::AdaptColors()
{
  vtkSMPropertyHelper lookupTable(this, "LookupTable", true);
  vtkSMProxy* colors = lookupTable.GetNumberOfElements() > 0 ? lookupTable.GetAsProxy() : nullptr;
  // Do not change a colour map that other displays share.
  if (!colors || !vtkSMPropertyHelper(this, "UseSeparateColorMap", true).GetAsInt() ||
    !this->GetUsingScalarColoring())
  {
    return;
  }
  if (vtkPVDataInformation* data = this->GetInputInformation())
  {
    this->AdaptColorsOf(vtkSMPropertyHelper(this, "ColorArrayName").GetAsString(4), colors, data);
  }
}

//------------------------------------------------------------------------------
void vtkSMVolumicSurfaceRepresentationProxy::AdaptColorsOf(
  const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data)
{
  if (array == "Component")
  {
    this->AdaptComponentColors(colors, data);
  }
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
  constexpr int others = static_cast<int>(ComponentColors.size());
  const int last = std::clamp(static_cast<int>(component->GetComponentRange(0)[1]), 0, others);
  const bool isOurs =
    static_cast<int>(volumic::CategoriesOf(colors).size()) == this->LastComponent + 1;
  if (last == this->LastComponent || (volumic::IsInitialized(colors) && !isOurs))
  {
    return;
  }
  std::vector<volumic::ColorCategory> categories;
  for (int c = 0; c < std::min(last + 1, others); ++c)
  {
    categories.push_back({ std::to_string(c), std::to_string(c), ComponentColors[c] });
  }
  if (last == others)
  {
    categories.push_back({ std::to_string(others), "others", volumic::OtherColor });
  }
  volumic::SetCategories(colors, categories);
  this->LastComponent = last;
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
  const char* position = hint->GetAttribute("position");
  if (position && std::strcmp(position, "last") == 0)
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
void vtkSMVolumicSurfaceRepresentationProxy::ChooseBlock()
{
  vtkSMPropertyHelper selectors(this, "BlockSelectors", true);
  // Keep blocks that the user has chosen.
  const std::string given = this->ChosenBlock.empty() ? "/" : this->ChosenBlock;
  if (!this->IsNew || selectors.GetNumberOfElements() != 1 || selectors.GetAsString(0) != given)
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
  os << indent << "LastComponent: " << this->LastComponent << "\n";
  os << indent << "ChosenBlock: " << this->ChosenBlock << "\n";
}
