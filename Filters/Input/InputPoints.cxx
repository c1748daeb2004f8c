// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputPoints.h"

#include "Core/Common/Refuse.h"
#include "Host/Errors.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <string>

namespace volumic
{
namespace
{
/** A point of a poly data. */
struct InputPoint
{
  vtkIdType Id;
  Point World;
  Point Place; ///< workspace
};

std::vector<vtkIdType> IdsMeantBy(vtkPolyData* polyData)
{
  const auto numberOfPoints = static_cast<std::size_t>(polyData->GetNumberOfPoints());
  std::vector<vtkIdType> ids;
  if (polyData->GetNumberOfCells() == 0)
  {
    ids.resize(numberOfPoints);
    std::iota(ids.begin(), ids.end(), vtkIdType(0));
    return ids;
  }
  if (polyData->GetNumberOfVerts() == 0)
  {
    Refuse("Points are wanted, but the data has lines or polygons and no vertices. Mark the points "
           "by vertices (vtkVertexGlyphFilter, in ParaView Convert To Point Cloud), or give them "
           "without any cells.");
  }
  if (const std::string fault = FaultOfCells(polyData); !fault.empty())
  {
    Refuse("The data ", fault);
  }
  std::vector<bool> isTaken(numberOfPoints, false);
  auto cells = vtk::TakeSmartPointer(polyData->GetVerts()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* points;
    cells->GetCurrentCell(size, points);
    for (vtkIdType i = 0; i < size; ++i)
    {
      if (!isTaken[points[i]])
      {
        isTaken[points[i]] = true;
        ids.push_back(points[i]);
      }
    }
  }
  return ids;
}

/**
 * The points that are meant by a poly data where points are asked for, whatever for: those of its
 * vertices (cells of the list Verts), each once, in their order; all its points where it has no
 * cells at all; none if it is null. Other cells beside vertices do not count.
 * @throws std::invalid_argument if it has cells, but no vertices: nothing says that the points of
 *         a line or of a surface are meant.
 */
std::vector<InputPoint> PointsMeantBy(vtkPolyData* polyData, const Workspace& space)
{
  std::vector<InputPoint> points;
  if (!polyData)
  {
    return points;
  }
  for (const vtkIdType id : IdsMeantBy(polyData))
  {
    InputPoint point;
    point.Id = id;
    polyData->GetPoint(id, point.World.data());
    point.Place = space.ToWorkspace(point.World);
    points.push_back(point);
  }
  return points;
}

/** Whether it has polygons and no vertices: then it is a surface, and no points are meant. */
bool IsSurfaceOnly(vtkPolyData* polyData)
{
  return polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() > 0 &&
    polyData->GetNumberOfVerts() == 0;
}

std::vector<Point> Places(const std::vector<InputPoint>& points)
{
  std::vector<Point> places;
  std::transform(points.begin(), points.end(), std::back_inserter(places),
    [](const InputPoint& point) { return point.Place; });
  return places;
}

/** The array of that name, null if there is none. */
vtkDataArray* NumbersOf(vtkPolyData* polyData, const char* name)
{
  vtkAbstractArray* found = polyData->GetPointData()->GetAbstractArray(name);
  auto* numbers = vtkDataArray::SafeDownCast(found);
  if (found && (!numbers || numbers->GetNumberOfComponents() != 1))
  {
    Refuse("the point array ", name, " must hold one number per point.");
  }
  return numbers;
}

double NumberAt(vtkDataArray* numbers, vtkIdType id, double missing)
{
  const double value = numbers ? numbers->GetComponent(id, 0) : missing;
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    Refuse(numbers->GetName(), " of point ", id, " is ", value, "; it must be 0 or more.");
  }
  return value;
}
}

std::vector<Point> SeedsOf(vtkPolyData* port1, const Workspace& space)
{
  if (port1 && IsSurfaceOnly(port1))
  {
    Refuse("The seeds must be vertices or mere points, but the data is a surface. Give the centres "
           "of the seeds, or set Initialization to Input Surface.");
  }
  return Places(PointsMeantBy(port1, space));
}

std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* port2, const Workspace& space, const std::array<int, 3>& size)
{
  std::vector<AttractingPoint> attracting;
  if (!port2)
  {
    return attracting;
  }
  vtkDataArray* weights = NumbersOf(port2, "Weight");
  vtkDataArray* radii = NumbersOf(port2, "Radius");
  for (const InputPoint& given : PointsMeantBy(port2, space))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      // A voxel of tolerance: there the field still ramps down to the background.
      const double step = space.Step()[axis];
      if (!(given.Place[axis] >= -step && given.Place[axis] <= step * size[axis]))
      {
        Refuse("point ", given.Id, " (", given.World[0], ", ", given.World[1], ", ", given.World[2],
          ") lies outside the image. Points are in world coordinates; leave it out.");
      }
    }
    AttractingPoint point;
    point.Place = given.Place;
    point.Weight = NumberAt(weights, given.Id, 1.0);
    point.Radius = NumberAt(radii, given.Id, 0.0) / space.WorldUnit();
    attracting.push_back(point);
  }
  return attracting;
}

std::vector<Point> PlacesOf(vtkPolyData* port1, vtkPolyData* port2, const Workspace& space)
{
  std::vector<InputPoint> points;
  if (port1 && !IsSurfaceOnly(port1))
  {
    points =
      PrefixErrors("Input port 1 (Initial Surface): ", [&] { return PointsMeantBy(port1, space); });
  }
  const std::vector<InputPoint> more =
    PrefixErrors("Input port 2 (Attracting Points): ", [&] { return PointsMeantBy(port2, space); });
  points.insert(points.end(), more.begin(), more.end());
  return Places(points);
}

std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label,
  const Workspace& space, const std::array<int, 3>& size)
{
  std::vector<Point> places;
  for (std::size_t id = 0; id < positions.size(); ++id)
  {
    const Point& world = positions[id];
    Point place = space.ToWorkspace(world);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = space.Step()[axis];
      const double length = step * size[axis];
      // Written so that NaN is refused too.
      if (!(place[axis] >= -step && place[axis] <= length + step))
      {
        Refuse(label, ": point ", id, " (", world[0], ", ", world[1], ", ", world[2],
          ") lies outside the image. Points are in world coordinates; move it into the image, or "
          "remove it.");
      }
      // Not the very end of the box, which the levels have rounded.
      place[axis] = std::max(0.0, std::min((1.0 - 1e-9) * length, place[axis]));
    }
    places.push_back(place);
  }
  return places;
}

std::string FaultOfCells(vtkPolyData* data)
{
  const vtkIdType points = data->GetNumberOfPoints();
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    if (!cells->IsValid())
    {
      return "is damaged: its cells overlap.";
    }
    double range[2] = { 0.0, -1.0 };
    if (cells->GetNumberOfConnectivityIds() > 0)
    {
      cells->GetConnectivityArray()->GetRange(range, 0);
    }
    if (range[0] < 0.0 || range[1] >= static_cast<double>(points))
    {
      return Join("is damaged: a cell has point ", range[0] < 0.0 ? range[0] : range[1],
        ", there are ", points, ".");
    }
  }
  return "";
}
}
