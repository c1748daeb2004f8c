// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PickOnSlices.h"

#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqRenderView.h>

#include <vtkPVDataInformation.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>

#include <algorithm>
#include <string>

namespace
{
/** From the eye on, through the mouse. */
struct Ray
{
  double Near[3];
  double Far[3];
};

Ray RayThrough(vtkRenderer* renderer, const int* place)
{
  Ray ray;
  double* ends[2] = { ray.Near, ray.Far };
  for (int end = 0; end < 2; ++end)
  {
    renderer->SetDisplayPoint(place[0], place[1], end);
    renderer->DisplayToWorld();
    const double* world = renderer->GetWorldPoint();
    std::transform(world, world + 3, ends[end], [&](double x) { return x / world[3]; });
  }
  return ray;
}

/** The axis that a slice is perpendicular to, by the property SliceMode. */
int AxisOf(int sliceMode)
{
  const int yz = 6;
  const int xz = 7;
  return sliceMode == yz ? 0 : sliceMode == xz ? 1 : 2;
}

/** The share of the ray at which it crosses the slice; above 1 if it doesn't. */
double ShareAtSlice(const Ray& ray, vtkSMProxy* display, vtkPVDataInformation* data)
{
  const int axis = AxisOf(vtkSMPropertyHelper(display, "SliceMode").GetAsInt());
  const int slice = vtkSMPropertyHelper(display, "Slice").GetAsInt();
  const double* bounds = data->GetBounds();
  const int* extent = data->GetExtent();
  const int last = std::max(1, extent[2 * axis + 1] - extent[2 * axis]);
  const double height =
    bounds[2 * axis] + (bounds[2 * axis + 1] - bounds[2 * axis]) * std::min(slice, last) / last;
  const double share = (height - ray.Near[axis]) / (ray.Far[axis] - ray.Near[axis]);
  bool isInside = share >= 0.0 && share <= 1.0; // not if it is NaN
  for (int other = 0; other < 3; ++other)
  {
    const double at = ray.Near[other] + share * (ray.Far[other] - ray.Near[other]);
    isInside = isInside &&
      (other == axis || (at >= bounds[2 * other] && at <= bounds[2 * other + 1]));
  }
  return isInside ? share : 2.0;
}
}

bool PickOnSlices(pqRenderView* view, double position[3])
{
  vtkSMRenderViewProxy* proxy = view ? view->getRenderViewProxy() : nullptr;
  if (!proxy || !proxy->GetInteractor())
  {
    return false;
  }
  const int* place = proxy->GetInteractor()->GetEventPosition();
  double found[3];
  double normal[3];
  if (proxy->ConvertDisplayToPointOnSurface(place, found, normal, false))
  {
    return false;
  }
  const Ray ray = RayThrough(proxy->GetRenderer(), place);
  double nearest = 2.0;
  for (pqRepresentation* shown : view->getRepresentations())
  {
    auto* display = qobject_cast<pqDataRepresentation*>(shown);
    const bool isSlice = display && display->isVisible() &&
      display->getProxy()->GetProperty("SliceMode") &&
      vtkSMPropertyHelper(display->getProxy(), "Representation").GetAsString() ==
        std::string("Slice");
    if (isSlice)
    {
      nearest = std::min(nearest,
        ShareAtSlice(
          ray, display->getProxy(), display->getOutputPortFromInput()->getDataInformation()));
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    position[axis] = ray.Near[axis] + nearest * (ray.Far[axis] - ray.Near[axis]);
  }
  return nearest <= 1.0;
}
