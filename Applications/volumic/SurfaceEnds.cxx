// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceEnds.h"

#include "CapMesh.h"
#include "SurfaceFacts.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkClipClosedSurface.h>
#include <vtkClipPolyData.h>
#include <vtkFeatureEdges.h>
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
#include <vtkTriangle.h>
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

/** How many times the length of edges a point may be off a plane in which it is. */
constexpr double InPlane = 1e-9;

/** Which of the first so many planes a triangle lies in; -1: none. */
int PlaneOf(vtkPolyData* surface, const vtkIdType* corners, const std::vector<Border>& borders,
  int count, double length)
{
  const auto isIn = [&](const Border& border)
  {
    return std::all_of(corners, corners + 3,
      [&](vtkIdType corner)
      { return border.Plane->DistanceToPlane(surface->GetPoint(corner)) < InPlane * length; });
  };
  const auto found = std::find_if(borders.begin(), borders.begin() + count, isIn);
  return found == borders.begin() + count ? -1 : static_cast<int>(found - borders.begin());
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

/**
 * Cut at a plane, and closed there. The caps, of the planes before it, too, are taken out of the
 * cells.
 */
vtkSmartPointer<vtkPolyData> CutAndClosed(vtkPolyData* surface, const std::vector<Border>& borders,
  int number, double length, std::vector<CapMesh::Triangle>& caps)
{
  vtkPlane* plane = borders[static_cast<std::size_t>(number)].Plane;
  vtkNew<vtkPlane> inward;
  inward->SetOrigin(plane->GetOrigin());
  const double* normal = plane->GetNormal();
  inward->SetNormal(-normal[0], -normal[1], -normal[2]);
  vtkNew<vtkPlaneCollection> planes;
  planes->AddItem(inward);
  vtkNew<vtkClipClosedSurface> clip;
  clip->SetInputData(surface);
  clip->SetClippingPlanes(planes);
  clip->SetScalarModeToLabels();
  clip->PassPointDataOn();
  clip->Update();
  vtkSmartPointer<vtkPolyData> made = clip->GetOutput();
  vtkDataArray* isNew = made->GetCellData()->GetScalars();
  vtkNew<vtkCellArray> others;
  ForEachPolygon(made,
    [&](vtkIdType cell, const vtkIdType* corners, vtkIdType count)
    {
      const bool isCap = isNew->GetComponent(cell, 0) != 0.0;
      const int own = isCap ? number : PlaneOf(made, corners, borders, number, length);
      if (own < 0)
      {
        others->InsertNextCell(count, corners);
        return;
      }
      caps.push_back({ { corners[0], corners[1], corners[2] }, own });
      for (int k = 0; k < 3 && isCap; ++k)
      {
        double place[3];
        made->GetPoint(corners[k], place);
        plane->ProjectPoint(place, place);
        made->GetPoints()->SetPoint(corners[k], place);
      }
    });
  made->SetPolys(others);
  made->GetCellData()->Initialize();
  return made;
}

/**
 * Whether caps close a surface and look outwards all over. Then nothing of them lies above other
 * parts of them, as their rims are where a surface without intersections meets a plane.
 */
bool IsSound(vtkPolyData* surface, const std::vector<CapMesh::Triangle>& caps,
  const std::vector<Border>& borders)
{
  vtkNew<vtkFeatureEdges> wrong;
  wrong->SetInputData(surface);
  wrong->FeatureEdgesOff();
  wrong->ManifoldEdgesOff();
  wrong->Update();
  return wrong->GetOutput()->GetNumberOfLines() == 0 &&
    std::all_of(caps.begin(), caps.end(),
      [&](const CapMesh::Triangle& cap)
      {
        double places[3][3];
        for (int k = 0; k < 3; ++k)
        {
          surface->GetPoint(cap.Corners[static_cast<std::size_t>(k)], places[k]);
        }
        double normal[3];
        vtkTriangle::ComputeNormalDirection(places[0], places[1], places[2], normal);
        return vtkMath::Dot(
                 normal, borders[static_cast<std::size_t>(cap.Plane)].Plane->GetNormal()) > 0.0;
      });
}

/**
 * Cut at the planes, in their order, and closed there by triangles as long as the surface's: one
 * plane after the other, as long thin triangles of a cap that the next plane cuts would leave it
 * open. @return null: this does not close it
 */
vtkSmartPointer<vtkPolyData> CappedInOrder(
  vtkPolyData* surface, const std::vector<Border>& borders, double length)
{
  auto made = vtkSmartPointer<vtkPolyData>::New();
  made->ShallowCopy(surface);
  vtkNew<vtkCellArray> others;
  others->DeepCopy(surface->GetPolys());
  std::vector<CapMesh::Triangle> caps;
  for (int number = 0; number < static_cast<int>(borders.size()); ++number)
  {
    caps.clear();
    made = CutAndClosed(made, borders, number, length, caps);
    CapMesh even(made, caps);
    even.MakeEven(length);
    caps = even.Triangles;
    others->DeepCopy(made->GetPolys());
    for (const CapMesh::Triangle& cap : caps)
    {
      made->GetPolys()->InsertNextCell(3, cap.Corners.data());
    }
    if (!IsSound(made, caps, borders))
    {
      return nullptr;
    }
  }
  SetCells(made, others, caps, borders);
  made->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return made;
}

/**
 * Cut at the planes and closed. A rim with many holes is more than vtkClipClosedSurface
 * triangulates at times: then the planes are taken in another order, and a hundredth of an edge
 * further within.
 * @return null: none of these tries closes it
 */
vtkSmartPointer<vtkPolyData> Capped(vtkPolyData* surface, std::vector<Border> borders)
{
  constexpr int mostTries = 24;
  constexpr double further = 0.01;
  const double length = MeanEdge(surface);
  const auto byFace = [](const Border& a, const Border& b) { return a.Face < b.Face; };
  vtkSmartPointer<vtkPolyData> made = CappedInOrder(surface, borders, length);
  for (int n = 1; n < mostTries && !made; ++n)
  {
    std::next_permutation(borders.begin(), borders.end(), byFace);
    for (const Border& border : borders)
    {
      border.Plane->Push(-further * length);
    }
    made = CappedInOrder(surface, borders, length);
  }
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

vtkSmartPointer<vtkPolyData> WithEnds(
  vtkPolyData* surface, vtkImageData* image, Ends ends, std::vector<std::string>& warnings)
{
  if (ends == Ends::Closed)
  {
    return surface;
  }
  const std::vector<Border> borders = BorderOf(image, surface);
  if (ends == Ends::Marked)
  {
    const vtkSmartPointer<vtkPolyData> made = Capped(surface, borders);
    if (!made)
    {
      warnings.push_back("its ends cannot be made flat: they stay as they are, and are not marked; "
                         "--ends open leaves them out, --region takes another part");
    }
    return made && made->GetNumberOfPolys() > 0 ? made : Capped(surface, {});
  }
  vtkSmartPointer<vtkPolyData> made = surface;
  for (const Border& border : borders)
  {
    made = Cut(made, border.Plane);
  }
  return made->GetNumberOfPolys() == 0 ? vtkSmartPointer<vtkPolyData>(surface) : made;
}
}
