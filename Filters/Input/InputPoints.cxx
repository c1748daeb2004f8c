// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/InputPoints.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/Errors.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkType.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

namespace volumic
{
namespace
{
/**
 * Return the points of the vertex cells, each once, in their order. Return all points if there are
 * no cells.
 * @param polyData may be null: no points
 * @throws Refusal if it has cells, but no vertices
 */
std::vector<vtkIdType> IdsMeantBy(vtkPolyData* polyData)
{
  std::vector<vtkIdType> ids;
  if (!polyData)
  {
    return ids;
  }
  const auto numberOfPoints = static_cast<std::size_t>(polyData->GetNumberOfPoints());
  if (polyData->GetNumberOfCells() == 0)
  {
    ids.resize(numberOfPoints);
    std::iota(ids.begin(), ids.end(), vtkIdType(0));
    return ids;
  }
  if (polyData->GetNumberOfVerts() == 0)
  {
    ThrowInvalidArgument(
      "Points are wanted, but the data has lines or polygons and no vertices. Mark the points "
      "by vertices (vtkVertexGlyphFilter, in ParaView Convert To Point Cloud), or give them "
      "without any cells.");
  }
  if (const std::string fault = FaultOfCells(polyData); !fault.empty())
  {
    ThrowInvalidArgument("The data ", fault);
  }
  std::vector<bool> isTaken(numberOfPoints, false);
  vtkDataArray* corners = polyData->GetVerts()->GetConnectivityArray();
  for (vtkIdType i = 0; i < corners->GetNumberOfTuples(); ++i)
  {
    const auto id = static_cast<vtkIdType>(corners->GetComponent(i, 0));
    if (!isTaken[id])
    {
      isTaken[id] = true;
      ids.push_back(id);
    }
  }
  return ids;
}

Point WorldOf(vtkPolyData* polyData, vtkIdType id)
{
  Point world;
  polyData->GetPoint(id, world.data());
  return world;
}

std::vector<Point> PointPositions(vtkPolyData* polyData, const ComputationalSpace& space)
{
  std::vector<Point> places;
  for (const vtkIdType id : IdsMeantBy(polyData))
  {
    places.push_back(space.ToComputationalSpace(WorldOf(polyData, id)));
  }
  return places;
}

/**
 * A point in the workspace.
 * @param beyond voxels that it may lie behind the end of the image; one is allowed before its begin
 */
Point CheckInside(const Point& world, vtkIdType id, const ComputationalSpace& space,
  const std::array<int, 3>& size, int beyond)
{
  const Point place = space.ToComputationalSpace(world);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double step = space.Step()[axis];
    // Written so that NaN is refused too.
    if (!(place[axis] >= -step && place[axis] <= step * (size[axis] + beyond)))
    {
      ThrowInvalidArgument("point ", id, " (", world[0], ", ", world[1], ", ", world[2],
        ") lies outside the image. Points are in world coordinates; move it into the image, or "
        "remove it.");
    }
  }
  return place;
}

/** Whether it has polygons and no vertices: then it is a surface, and no points are meant. */
bool IsSurfaceOnly(vtkPolyData* polyData)
{
  return polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() > 0 &&
    polyData->GetNumberOfVerts() == 0;
}

/** The number that a point has in an array, if there is one of that name. */
double NumberAt(vtkPolyData* polyData, const char* name, vtkIdType id, double missing)
{
  vtkAbstractArray* found = polyData->GetPointData()->GetAbstractArray(name);
  auto* numbers = vtkDataArray::SafeDownCast(found);
  if (found && (!numbers || numbers->GetNumberOfComponents() != 1))
  {
    ThrowInvalidArgument("the point array ", name, " must hold one number per point.");
  }
  const double value = numbers ? numbers->GetComponent(id, 0) : missing;
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    ThrowInvalidArgument(name, " of point ", id, " is ", value, "; it must be 0 or more.");
  }
  return value;
}
}

std::vector<Point> SeedsOf(vtkPolyData* port1, const ComputationalSpace& space)
{
  if (port1 && IsSurfaceOnly(port1))
  {
    ThrowInvalidArgument(
      "The seeds must be vertices or mere points, but the data is a surface. Give the centres "
      "of the seeds, or set Initialization to Input Surface.");
  }
  return PointPositions(port1, space);
}

std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* port2, const ComputationalSpace& space, const std::array<int, 3>& size)
{
  std::vector<AttractingPoint> attracting;
  for (const vtkIdType id : IdsMeantBy(port2))
  {
    AttractingPoint point;
    // There the field still ramps down to the background.
    point.Position = CheckInside(WorldOf(port2, id), id, space, size, 0);
    point.Weight = NumberAt(port2, "Weight", id, 1.0);
    point.Radius = NumberAt(port2, "Radius", id, 0.0) / space.WorldUnit();
    attracting.push_back(point);
  }
  return attracting;
}

std::vector<Point> SelectionPositions(
  vtkPolyData* port1, vtkPolyData* port2, const ComputationalSpace& space)
{
  std::vector<Point> places;
  if (port1 && !IsSurfaceOnly(port1))
  {
    places = PrefixErrors(
      "Input port 1 (Initial Surface): ", [&] { return PointPositions(port1, space); });
  }
  const std::vector<Point> more = PrefixErrors(
    "Input port 2 (Attracting Points): ", [&] { return PointPositions(port2, space); });
  places.insert(places.end(), more.begin(), more.end());
  return places;
}

std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label,
  const ComputationalSpace& space, const std::array<int, 3>& size)
{
  std::vector<Point> places;
  for (const Point& world : positions)
  {
    const auto id = static_cast<vtkIdType>(places.size());
    places.push_back(
      PrefixErrors(Join(label, ": "), [&] { return CheckInside(world, id, space, size, 1); }));
    for (int axis = 0; axis < 3; ++axis)
    {
      // Not the very end of the box, which the levels have rounded.
      const double end = (1.0 - 1e-9) * (space.Step()[axis] * size[axis]);
      places.back()[axis] = std::max(0.0, std::min(end, places.back()[axis]));
    }
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
