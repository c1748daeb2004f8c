// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEnds.h"

#include "SurfaceFacts.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkClipPolyData.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkTriangle.h>

#include <algorithm>
#include <vector>

namespace tool
{
namespace
{
bool IsBeyond(vtkPlane* plane, vtkPolyData* surface, vtkIdType point)
{
  return plane->EvaluateFunction(surface->GetPoint(point)) > 0.0;
}

/**
 * For each side of the image where the surface goes beyond the centres of the outermost voxels a
 * plane, a voxel within these, with a normal that points out of the image: a cap lies about the
 * centres, in some places within them.
 */
std::vector<vtkSmartPointer<vtkPlane>> BorderOf(vtkImageData* image, vtkPolyData* surface)
{
  std::vector<vtkSmartPointer<vtkPlane>> planes;
  const int* extent = image->GetExtent();
  for (int face = 0; face < 6; ++face)
  {
    const int axisOfFace = face / 2;
    int index[3] = { extent[0], extent[2], extent[4] };
    double origin[3];
    double normal[3];
    index[axisOfFace] = extent[face];
    image->TransformIndexToPhysicalPoint(index, origin);
    for (int axis = 0; axis < 3; ++axis)
    {
      normal[axis] =
        (face % 2 == 0 ? -1.0 : 1.0) * image->GetDirectionMatrix()->GetElement(axis, axisOfFace);
    }
    const auto plane = vtkSmartPointer<vtkPlane>::New();
    plane->SetOrigin(origin);
    plane->SetNormal(normal);
    bool isLeft = false;
    for (vtkIdType point = 0; point < surface->GetNumberOfPoints() && !isLeft; ++point)
    {
      isLeft = IsBeyond(plane, surface, point);
    }
    if (isLeft)
    {
      plane->Push(-image->GetSpacing()[axisOfFace]);
      planes.push_back(plane);
    }
  }
  return planes;
}

/** Whether a triangle looks out of the image rather than along its border. */
bool LooksOut(vtkPolyData* surface, const vtkIdType* corners, vtkPlane* plane)
{
  double places[3][3];
  double normal[3];
  for (int i = 0; i < 3; ++i)
  {
    surface->GetPoint(corners[i], places[i]);
  }
  vtkTriangle::ComputeNormal(places[0], places[1], places[2], normal);
  return vtkMath::Dot(normal, plane->GetNormal()) > 0.7;
}

/** Triangles beyond a plane that look outwards and share points are a cap. */
void MarkCaps(vtkPolyData* surface, vtkImageData* image)
{
  vtkNew<vtkIntArray> caps;
  caps->SetName("Cap");
  caps->SetNumberOfValues(surface->GetNumberOfCells());
  caps->FillValue(0);
  int last = 0;
  for (const auto& plane : BorderOf(image, surface))
  {
    std::vector<vtkIdType> triangles;
    vtkNew<vtkCellArray> beyond;
    ForEachPolygon(surface,
      [&](vtkIdType triangle, const vtkIdType* corners, vtkIdType count)
      {
        if (std::all_of(corners, corners + count,
              [&](vtkIdType corner) { return IsBeyond(plane, surface, corner); }) &&
          LooksOut(surface, corners, plane))
        {
          triangles.push_back(triangle);
          beyond->InsertNextCell(count, corners);
        }
      });
    vtkNew<vtkPolyData> part;
    part->SetPoints(surface->GetPoints());
    part->SetPolys(beyond);
    vtkNew<vtkPolyDataConnectivityFilter> connect;
    connect->SetInputData(part);
    connect->SetExtractionModeToAllRegions();
    connect->ColorRegionsOn();
    connect->Update();
    vtkDataArray* regions = connect->GetOutput()->GetPointData()->GetArray("RegionId");
    ForEachPolygon(connect->GetOutput(),
      [&](vtkIdType number, const vtkIdType* corners, vtkIdType)
      {
        caps->SetValue(triangles[static_cast<std::size_t>(number)],
          last + 1 + static_cast<int>(regions->GetComponent(corners[0], 0)));
      });
    last += connect->GetNumberOfExtractedRegions();
  }
  surface->GetCellData()->AddArray(caps);
}

vtkSmartPointer<vtkPolyData> Cut(vtkPolyData* surface, vtkPlane* plane)
{
  vtkNew<vtkClipPolyData> clip;
  clip->SetInputData(surface);
  clip->SetClipFunction(plane);
  clip->InsideOutOn();
  clip->Update();
  vtkSmartPointer<vtkPolyData> rest = clip->GetOutput();
  rest->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return rest;
}
}

vtkSmartPointer<vtkPolyData> WithEnds(vtkPolyData* surface, vtkImageData* image, Ends ends)
{
  vtkSmartPointer<vtkPolyData> made = surface;
  if (ends == Ends::Marked)
  {
    MarkCaps(surface, image);
  }
  else if (ends == Ends::Open)
  {
    for (const auto& plane : BorderOf(image, surface))
    {
      made = Cut(made, plane);
    }
  }
  return made;
}
}
