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
 * no cells, and no points for null.
 * @throws InvalidArgument if there are cells, but no vertices
 */
std::vector<vtkIdType> PointIds(vtkPolyData* polyData)
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
      "the data have lines or polygons, but no vertices, which mark the points. Add vertices "
      "(vtkVertexGlyphFilter; ParaView: Convert To Point Cloud), or remove all cells.");
  }
  if (const std::string error = FindInvalidCells(polyData); !error.empty())
  {
    ThrowInvalidArgument("the data ", error);
  }
  std::vector<bool> isListed(numberOfPoints, false);
  vtkDataArray* corners = polyData->GetVerts()->GetConnectivityArray();
  for (vtkIdType i = 0; i < corners->GetNumberOfTuples(); ++i)
  {
    const auto id = static_cast<vtkIdType>(corners->GetComponent(i, 0));
    if (!isListed[id])
    {
      isListed[id] = true;
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
  std::vector<Point> positions;
  for (const vtkIdType id : PointIds(polyData))
  {
    positions.push_back(space.ToComputationalSpace(WorldOf(polyData, id)));
  }
  return positions;
}

/**
 * Return a point in computational space.
 * @param margin voxels that it may lie beyond the last voxel layer; one is allowed before the first
 * @throws InvalidArgument if it lies farther outside
 */
Point CheckInside(const Point& world, vtkIdType id, const ComputationalSpace& space,
  const std::array<int, 3>& size, int margin)
{
  const Point position = space.ToComputationalSpace(world);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double step = space.Step()[axis];
    if (!(position[axis] >= -step && position[axis] <= step * (size[axis] + margin)))
    {
      ThrowInvalidArgument("point ", id, " (", world[0], ", ", world[1], ", ", world[2],
        ") is outside the image. Move it into the image (world coordinates), or remove it.");
    }
  }
  return position;
}

bool IsSurfaceOnly(vtkPolyData* polyData)
{
  return polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() > 0 &&
    polyData->GetNumberOfVerts() == 0;
}

/** Return the value of a point in an optional array. */
double NumberAt(vtkPolyData* polyData, const char* name, vtkIdType id, double missing)
{
  vtkAbstractArray* found = polyData->GetPointData()->GetAbstractArray(name);
  auto* numbers = vtkDataArray::SafeDownCast(found);
  if (found && (!numbers || numbers->GetNumberOfComponents() != 1))
  {
    ThrowInvalidArgument(
      "point array '", name, "' is not numeric with one component. Provide one number per point.");
  }
  const double value = numbers ? numbers->GetComponent(id, 0) : missing;
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    ThrowInvalidArgument(name, " of point ", id, " is ", value, ". Set it to 0 or more.");
  }
  return value;
}
}

std::vector<Point> SeedsOf(vtkPolyData* port1, const ComputationalSpace& space)
{
  if (port1 && IsSurfaceOnly(port1))
  {
    ThrowInvalidArgument(
      "the data are a surface, not seeds. Connect the centers of the seeds as "
      "vertices or as points without cells, or set Initialization to Input Surface.");
  }
  return PointPositions(port1, space);
}

std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* port2, const ComputationalSpace& space, const std::array<int, 3>& size)
{
  std::vector<AttractingPoint> attracting;
  for (const vtkIdType id : PointIds(port2))
  {
    AttractingPoint point;
    // Beyond the last voxel layer the field decreases to the background.
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
  std::vector<Point> positions;
  if (port1 && !IsSurfaceOnly(port1))
  {
    positions = PrefixErrors(
      "Input port 1 (Initial Surface): ", [&] { return PointPositions(port1, space); });
  }
  const std::vector<Point> more = PrefixErrors(
    "Input port 2 (Attracting Points): ", [&] { return PointPositions(port2, space); });
  positions.insert(positions.end(), more.begin(), more.end());
  return positions;
}

std::vector<Point> PositionsOf(const std::vector<Point>& worldPositions, const char* label,
  const ComputationalSpace& space, const std::array<int, 3>& size)
{
  std::vector<Point> positions;
  for (const Point& world : worldPositions)
  {
    const auto id = static_cast<vtkIdType>(positions.size());
    positions.push_back(
      PrefixErrors(Join(label, ": "), [&] { return CheckInside(world, id, space, size, 1); }));
    for (int axis = 0; axis < 3; ++axis)
    {
      // Stay off the end of the box, which is rounded at coarser levels.
      const double end = (1.0 - 1e-9) * (space.Step()[axis] * size[axis]);
      positions.back()[axis] = std::max(0.0, std::min(end, positions.back()[axis]));
    }
  }
  return positions;
}

std::string FindInvalidCells(vtkPolyData* data)
{
  const vtkIdType points = data->GetNumberOfPoints();
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    if (!cells->IsValid())
    {
      return "have invalid cells: offsets and connectivity do not match. Repair the file.";
    }
    double range[2]; // the greatest and the least number without cells
    cells->GetConnectivityArray()->GetRange(range, 0);
    if (range[0] < 0.0 || range[1] >= static_cast<double>(points))
    {
      return Join("have a cell with point ", range[0] < 0.0 ? range[0] : range[1], ", but only ",
        points, " points. Repair the file.");
    }
  }
  for (vtkIdType strip = 0; strip < data->GetNumberOfStrips(); ++strip)
  {
    if (data->GetStrips()->GetCellSize(strip) < 3) // vtkTriangleFilter crashes.
    {
      return Join("have strip ", strip, " with less than 3 points. Remove it.");
    }
  }
  return "";
}
}
