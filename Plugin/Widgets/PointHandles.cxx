// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointHandles.h"

#include <pqRenderView.h>

#include <vtk3DWidgetRepresentation.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkPointHandleRepresentation3D.h>
#include <vtkProperty.h>
#include <vtkSMNewWidgetRepresentationProxy.h>
#include <vtkSMParaViewPipelineController.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>

#include <algorithm>
#include <utility>

namespace
{
/** Seen on slices of all colours; ParaView's own handles are thin and white. */
void MakeVisible(vtkSMNewWidgetRepresentationProxy* handle)
{
  auto* widget = vtk3DWidgetRepresentation::SafeDownCast(handle->GetClientSideObject());
  auto* cross = vtkPointHandleRepresentation3D::SafeDownCast(
    widget ? widget->GetRepresentation() : nullptr);
  if (cross)
  {
    cross->GetProperty()->SetColor(1.0, 0.0, 1.0);
    cross->GetProperty()->SetLineWidth(3.0);
    cross->SetHandleSize(25.0);
  }
}
}

//------------------------------------------------------------------------------
PointHandles::PointHandles(
  std::function<void(std::size_t index, const Position& position)> dragged,
  std::function<void()> released)
  : Dragged(std::move(dragged)), Released(std::move(released))
{
}

PointHandles::~PointHandles() = default;

vtkSMProperty* PointHandles::Handle::WorldPosition() const
{
  return this->Proxy->GetProperty("WorldPosition");
}

//------------------------------------------------------------------------------
void PointHandles::Place(pqRenderView* view, const std::vector<Position>& positions)
{
  this->IsPlacing = true;
  while (this->Handles.size() > positions.size())
  {
    this->RemoveLast(view);
  }
  while (this->Handles.size() < positions.size())
  {
    this->Add(view);
  }
  if (view)
  {
    view->getProxy()->UpdateVTKObjects();
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    vtkSMPropertyHelper(this->Handles[i].WorldPosition()).Set(positions[i].data(), 3);
    this->Handles[i].Proxy->UpdateVTKObjects();
  }
  this->IsPlacing = false;
}

void PointHandles::Add(pqRenderView* view)
{
  vtkSMSessionProxyManager* manager = view->getProxy()->GetSessionProxyManager();
  auto made = vtkSmartPointer<vtkSMProxy>::Take(
    manager->NewProxy("representations", "HandleWidgetRepresentation"));
  Handle handle;
  handle.Proxy = vtkSMNewWidgetRepresentationProxy::SafeDownCast(made);
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->InitializeProxy(handle.Proxy);
  handle.Proxy->UpdateVTKObjects();
  MakeVisible(handle.Proxy);
  // Undo is not to know of it.
  handle.Proxy->PrototypeOn();
  handle.DragTag = handle.WorldPosition()->AddObserver(
    vtkCommand::ModifiedEvent, this, &PointHandles::OnDrag);
  handle.ReleaseTag = handle.Proxy->AddObserver(
    vtkCommand::EndInteractionEvent, this, &PointHandles::OnRelease);
  vtkSMPropertyHelper(view->getProxy(), "HiddenRepresentations").Add(handle.Proxy);
  this->Handles.push_back(handle);
}

void PointHandles::RemoveLast(pqRenderView* view)
{
  const Handle& handle = this->Handles.back();
  if (view)
  {
    vtkSMPropertyHelper(view->getProxy(), "HiddenRepresentations").Remove(handle.Proxy);
  }
  handle.WorldPosition()->RemoveObserver(handle.DragTag);
  handle.Proxy->RemoveObserver(handle.ReleaseTag);
  this->Handles.pop_back();
}

void PointHandles::SetVisible(bool visible)
{
  for (const Handle& handle : this->Handles)
  {
    vtkSMPropertyHelper(handle.Proxy, "Visibility").Set(visible ? 1 : 0);
    vtkSMPropertyHelper(handle.Proxy, "Enabled").Set(visible ? 1 : 0);
    handle.Proxy->UpdateVTKObjects();
  }
}

//------------------------------------------------------------------------------
void PointHandles::OnDrag(vtkObject* position, unsigned long, void*)
{
  const auto moved = std::find_if(this->Handles.begin(), this->Handles.end(),
    [&](const Handle& handle) { return handle.WorldPosition() == position; });
  if (this->IsPlacing || moved == this->Handles.end())
  {
    return;
  }
  vtkSMPropertyHelper values(moved->WorldPosition());
  this->Dragged(static_cast<std::size_t>(moved - this->Handles.begin()),
    { values.GetAsDouble(0), values.GetAsDouble(1), values.GetAsDouble(2) });
}

void PointHandles::OnRelease(vtkObject*, unsigned long, void*)
{
  this->Released();
}
