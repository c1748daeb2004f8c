// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumicHistoryEntryProxy.h"

#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxyIterator.h>
#include <vtkSMProxySelectionModel.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkSMViewProxy.h>
#include <vtkSmartPointer.h>

#include <cstring>

vtkStandardNewMacro(vtkSMVolumicHistoryEntryProxy);

namespace
{
constexpr const char* ChartName = "VolumicHistoryView";
}

//------------------------------------------------------------------------------
vtkSMVolumicHistoryEntryProxy::vtkSMVolumicHistoryEntryProxy() = default;
vtkSMVolumicHistoryEntryProxy::~vtkSMVolumicHistoryEntryProxy() = default;

//------------------------------------------------------------------------------
void vtkSMVolumicHistoryEntryProxy::UpdateVTKObjects()
{
  this->Superclass::UpdateVTKObjects();
  vtkSMPropertyHelper visibility(this, "Visibility", true);
  vtkSMPropertyHelper input(this, "Input", true);
  auto* source = vtkSMSourceProxy::SafeDownCast(
    input.GetNumberOfElements() > 0 ? input.GetAsProxy() : nullptr);
  if (this->IsShowing || !this->ObjectsCreated || !source || !visibility.GetAsInt())
  {
    return;
  }
  this->IsShowing = true;
  visibility.Set(0);
  this->Superclass::UpdateVTKObjects();
  this->ShowChart(source, input.GetOutputPort());
  this->IsShowing = false;
}

//------------------------------------------------------------------------------
void vtkSMVolumicHistoryEntryProxy::ShowChart(vtkSMSourceProxy* source, unsigned int port)
{
  vtkSMViewProxy* chart = this->FindChart(source, port);
  const bool isThere = chart != nullptr;
  chart = isThere ? chart : this->OpenChart();
  if (!chart)
  {
    return;
  }
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->Show(source, static_cast<int>(port), chart);
  if (isThere)
  {
    vtkSMProxySelectionModel* active =
      this->GetSessionProxyManager()->GetSelectionModel("ActiveView");
    if (active)
    {
      active->SetCurrentProxy(chart, vtkSMProxySelectionModel::CLEAR_AND_SELECT);
    }
  }
}

//------------------------------------------------------------------------------
vtkSMViewProxy* vtkSMVolumicHistoryEntryProxy::FindChart(
  vtkSMSourceProxy* source, unsigned int port)
{
  vtkNew<vtkSMProxyIterator> views;
  views->SetSessionProxyManager(this->GetSessionProxyManager());
  views->SetModeToOneGroup();
  for (views->Begin("views"); !views->IsAtEnd(); views->Next())
  {
    auto* view = vtkSMViewProxy::SafeDownCast(views->GetProxy());
    if (view && view->GetXMLName() && std::strcmp(view->GetXMLName(), ChartName) == 0 &&
      view->FindRepresentation(source, static_cast<int>(port)))
    {
      return view;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
vtkSMViewProxy* vtkSMVolumicHistoryEntryProxy::OpenChart()
{
  vtkSMSessionProxyManager* manager = this->GetSessionProxyManager();
  auto proxy = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("views", ChartName));
  auto* chart = vtkSMViewProxy::SafeDownCast(proxy);
  if (!chart)
  {
    return nullptr;
  }
  vtkSMProxySelectionModel* active = manager->GetSelectionModel("ActiveView");
  auto* neighbour =
    vtkSMViewProxy::SafeDownCast(active ? active->GetCurrentProxy() : nullptr);
  vtkSMViewLayoutProxy* layout = neighbour ? vtkSMViewLayoutProxy::FindLayout(neighbour) : nullptr;
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->InitializeProxy(chart);
  controller->RegisterViewProxy(chart);
  controller->AssignViewToLayout(chart, layout, layout ? layout->GetViewLocation(neighbour) : -1);
  return chart;
}

//------------------------------------------------------------------------------
void vtkSMVolumicHistoryEntryProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
