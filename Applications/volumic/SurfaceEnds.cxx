// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEnds.h"

#include "CapMesh.h"
#include "SurfaceFacts.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkClipClosedSurface.h>
#include <vtkClipPolyData.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkMath.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tool
{
namespace
{
bool IsBeyond(vtkPlane* plane, vtkPolyData* surface, vtkIdType point)
{
  return plane->EvaluateFunction(surface->GetPoint(point)) > 0.0;
}

struct Border
{
  vtkSmartPointer<vtkPlane> Plane;
  int Face; ///< as `BoxFace` has it: 1 to 6
};

/**
 * For each side of the image where the surface goes beyond the centres of the outermost voxels a
 * plane, a voxel within these, with a normal that points out of the image: a cap lies about the
 * centres, in some places within them.
 */
std::vector<Border> BorderOf(vtkImageData* image, vtkPolyData* surface)
{
  std::vector<Border> borders;
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
      borders.push_back({ plane, face + 1 });
    }
  }
  return borders;
}

/** Which of the planes a triangle lies in. */
int PlaneOf(
  vtkPolyData* surface, const std::array<vtkIdType, 3>& corners, const std::vector<Border>& borders)
{
  const auto distanceTo = [&](const Border& border)
  {
    double most = 0.0;
    for (const vtkIdType corner : corners)
    {
      most = std::max(most, border.Plane->DistanceToPlane(surface->GetPoint(corner)));
    }
    return most;
  };
  return static_cast<int>(
    std::min_element(borders.begin(), borders.end(),
      [&](const Border& p, const Border& q) { return distanceTo(p) < distanceTo(q); }) -
    borders.begin());
}

double MeanEdge(vtkPolyData* surface)
{
  double sum = 0.0;
  ForEachPolygon(surface,
    [&](vtkIdType, const vtkIdType* corners, vtkIdType count)
    {
      for (vtkIdType k = 0; k < count; ++k)
      {
        double from[3];
        surface->GetPoint(corners[k], from);
        sum += std::sqrt(
          vtkMath::Distance2BetweenPoints(from, surface->GetPoint(corners[(k + 1) % count])));
      }
    });
  return sum / (3.0 * static_cast<double>(std::max<vtkIdType>(surface->GetNumberOfPolys(), 1)));
}

/** Numbers triangles of a plane that hang together, from `first` on. @return how many parts */
int NumberParts(vtkPolyData* surface, const std::vector<CapMesh::Triangle>& caps, int plane,
  int first, std::vector<int>& numbers)
{
  std::vector<std::size_t> own;
  vtkNew<vtkCellArray> cells;
  for (std::size_t t = 0; t < caps.size(); ++t)
  {
    if (caps[t].Plane == plane)
    {
      own.push_back(t);
      cells->InsertNextCell(3, caps[t].Corners.data());
    }
  }
  vtkNew<vtkPolyData> part;
  part->SetPoints(surface->GetPoints());
  part->SetPolys(cells);
  vtkNew<vtkPolyDataConnectivityFilter> connect;
  connect->SetInputData(part);
  connect->SetExtractionModeToAllRegions();
  connect->ColorRegionsOn();
  connect->Update();
  vtkDataArray* regions = connect->GetOutput()->GetPointData()->GetArray("RegionId");
  ForEachPolygon(connect->GetOutput(),
    [&](vtkIdType number, const vtkIdType* corners, vtkIdType)
    {
      numbers[own[static_cast<std::size_t>(number)]] =
        first + static_cast<int>(regions->GetComponent(corners[0], 0));
    });
  return connect->GetNumberOfExtractedRegions();
}

/** Gives a surface these triangles, with `Cap` and `BoxFace`. */
void SetCells(vtkPolyData* surface, vtkCellArray* others,
  const std::vector<CapMesh::Triangle>& caps, const std::vector<Border>& borders)
{
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Cap");
  vtkNew<vtkUnsignedCharArray> faces;
  faces->SetName("BoxFace");
  for (vtkIdType cell = 0; cell < others->GetNumberOfCells(); ++cell)
  {
    numbers->InsertNextValue(0);
    faces->InsertNextValue(0);
  }
  std::vector<int> parts(caps.size());
  int next = 1;
  for (int plane = 0; plane < static_cast<int>(borders.size()); ++plane)
  {
    next += NumberParts(surface, caps, plane, next, parts);
  }
  for (std::size_t t = 0; t < caps.size(); ++t)
  {
    others->InsertNextCell(3, caps[t].Corners.data());
    numbers->InsertNextValue(parts[t]);
    faces->InsertNextValue(
      static_cast<unsigned char>(borders[static_cast<std::size_t>(caps[t].Plane)].Face));
  }
  surface->SetPolys(others);
  surface->GetCellData()->AddArray(numbers);
  surface->GetCellData()->AddArray(faces);
}

/** Cut at the planes, and closed there by triangles as long as the surface's. */
vtkSmartPointer<vtkPolyData> Capped(vtkPolyData* surface, const std::vector<Border>& borders)
{
  vtkNew<vtkCellArray> others;
  if (borders.empty())
  {
    const auto same = vtkSmartPointer<vtkPolyData>::New();
    same->ShallowCopy(surface);
    others->DeepCopy(surface->GetPolys());
    SetCells(same, others, {}, {});
    return same;
  }
  vtkNew<vtkPlaneCollection> planes;
  for (const Border& border : borders)
  {
    vtkNew<vtkPlane> inward;
    inward->SetOrigin(border.Plane->GetOrigin());
    const double* normal = border.Plane->GetNormal();
    inward->SetNormal(-normal[0], -normal[1], -normal[2]);
    planes->AddItem(inward);
  }
  vtkNew<vtkClipClosedSurface> clip;
  clip->SetInputData(surface);
  clip->SetClippingPlanes(planes);
  clip->SetScalarModeToLabels();
  clip->PassPointDataOn();
  clip->Update();
  vtkSmartPointer<vtkPolyData> made = clip->GetOutput();
  vtkDataArray* isNew = made->GetCellData()->GetScalars();
  std::vector<CapMesh::Triangle> caps;
  ForEachPolygon(made,
    [&](vtkIdType cell, const vtkIdType* corners, vtkIdType count)
    {
      if (isNew->GetComponent(cell, 0) == 0.0)
      {
        others->InsertNextCell(count, corners);
        return;
      }
      const std::array<vtkIdType, 3> triangle = { corners[0], corners[1], corners[2] };
      caps.push_back({ triangle, PlaneOf(made, triangle, borders) });
      for (const vtkIdType corner : triangle)
      {
        double place[3];
        made->GetPoint(corner, place);
        borders[static_cast<std::size_t>(caps.back().Plane)].Plane->ProjectPoint(place, place);
        made->GetPoints()->SetPoint(corner, place);
      }
    });
  CapMesh even(made, caps);
  even.MakeEven(MeanEdge(surface));
  made->GetCellData()->Initialize();
  SetCells(made, others, even.Triangles, borders);
  made->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return made;
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
  if (ends == Ends::Closed)
  {
    return made;
  }
  const std::vector<Border> borders = BorderOf(image, surface);
  if (ends == Ends::Marked)
  {
    made = Capped(surface, borders);
  }
  for (std::size_t n = 0; n < borders.size() && ends == Ends::Open; ++n)
  {
    made = Cut(made, borders[n].Plane);
  }
  if (made->GetNumberOfPolys() == 0 && ends == Ends::Marked)
  {
    return Capped(surface, {});
  }
  return made->GetNumberOfPolys() == 0 ? vtkSmartPointer<vtkPolyData>(surface) : made;
}
}
