// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Judge surfaces in files with CGAL and with code that is independent of Volumic. Print a line for
 * each file; --help prints the names of the columns.
 *
 *     JudgeFiles [--map MAP.vti] FILE.vtp...
 *
 * Edges and close pairs are judged by the delta in the field data, or by the deltas at the points
 * of a graded surface. These are world units only for Metric World. Without deltas the columns are
 * "nan". Ratios are radius ratios.
 *
 * With a map, the files are surfaces of its labels, named by the field data `Label`. They are also
 * judged together and against the voxels: `wrong` counts misclassified voxels, `on` those whose
 * centres are on the surface and may be on either side.
 */

#include "MisclassifiedVoxels.h"
#include "SupportVtkConversions.h"
#include "SurfaceJudge.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangle.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
using namespace volumic::support;

/** A surface, its labels, and its errors against the label map. */
struct NamedSurface : TriangleSurface
{
  std::set<double> Labels;
  std::vector<double> Deltas; ///< of the points; empty if the file has none
  std::size_t Crossing = 0;   ///< intersections of all surfaces together
  std::size_t CentresOn = 0;  ///< voxels with centres on the surface
  std::size_t MisclassifiedVoxels = 0;
};

NamedSurface ReadSurface(const std::string& file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !data)
  {
    throw std::invalid_argument("Cannot read " + file);
  }
  if (data->GetNumberOfCells() != data->GetNumberOfPolys())
  {
    throw std::invalid_argument(file + " has cells that are not polygons");
  }
  NamedSurface surface;
  static_cast<TriangleSurface&>(surface) = ToTriangleSurface(data);
  surface.Deltas = DeltasOf(data);
  vtkDataArray* labels = data->GetFieldData()->GetArray("Label");
  for (vtkIdType i = 0; labels && i < labels->GetNumberOfTuples(); ++i)
  {
    surface.Labels.insert(labels->GetComponent(i, 0));
  }
  return surface;
}

/** Return the number of voxels whose centres are on the surface. */
std::size_t CountCentresOn(const TriangleSurface& inIndices, const std::array<int, 3>& size)
{
  constexpr double tolerance = 1e-5;
  std::set<std::array<int, 3>> found;
  vtkNew<vtkTriangle> triangle;
  for (const std::array<int, 3>& corners : inIndices.Triangles)
  {
    std::array<int, 3> low;
    std::array<int, 3> high;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto at = [&](int c) { return inIndices.Points[corners[c]][axis]; };
      const auto [least, most] = std::minmax({ at(0), at(1), at(2) });
      low[axis] = std::max(0, static_cast<int>(std::ceil(least - tolerance)));
      high[axis] = std::min(size[axis] - 1, static_cast<int>(std::floor(most + tolerance)));
      triangle->GetPoints()->SetPoint(axis, inIndices.Points[corners[axis]].data());
    }
    for (std::array<int, 3> v = low; v[2] <= high[2]; ++v[2])
    {
      for (v[1] = low[1]; v[1] <= high[1]; ++v[1])
      {
        for (v[0] = low[0]; v[0] <= high[0]; ++v[0])
        {
          const double centre[3] = { double(v[0]), double(v[1]), double(v[2]) };
          double nearest[3];
          double parametric[3];
          double weights[3];
          double squared = 1.;
          int part = 0;
          triangle->EvaluatePosition(centre, nearest, part, parametric, squared, weights);
          if (squared <= tolerance * tolerance)
          {
            found.insert(v);
          }
        }
      }
    }
  }
  return found.size();
}

void FindMisclassifiedVoxels(NamedSurface& surface, vtkImageData* map)
{
  TriangleSurface inIndices = surface;
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    map->TransformPhysicalPointToContinuousIndex(
      surface.Points[p].data(), inIndices.Points[p].data());
  }
  std::array<int, 3> size;
  map->GetDimensions(size.data());
  surface.CentresOn = CountCentresOn(inIndices, size);
  const std::vector<char> enclosed = EnclosedVoxels(inIndices, size);
  for (std::size_t v = 0; v < enclosed.size(); ++v)
  {
    const double label = map->GetPointData()->GetScalars()->GetTuple1(static_cast<vtkIdType>(v));
    surface.MisclassifiedVoxels += (surface.Labels.count(label) != 0) != (enclosed[v] != 0);
  }
}

/** Return all triangles; a triangle shared by two surfaces occurs once. */
TriangleSurface Together(const std::vector<NamedSurface>& surfaces)
{
  TriangleSurface all;
  std::map<std::array<double, 3>, int> points;
  std::set<std::array<int, 3>> triangles; // by sorted corners
  for (const NamedSurface& surface : surfaces)
  {
    for (std::array<int, 3> triangle : surface.Triangles)
    {
      for (int& corner : triangle)
      {
        const auto& point = surface.Points[static_cast<std::size_t>(corner)];
        const auto added = points.emplace(point, static_cast<int>(all.Points.size()));
        if (added.second)
        {
          all.Points.push_back(point);
        }
        corner = added.first->second;
      }
      std::array<int, 3> sorted = triangle;
      std::sort(sorted.begin(), sorted.end());
      if (triangles.insert(sorted).second)
      {
        all.Triangles.push_back(triangle);
      }
    }
  }
  return all;
}

void JudgeLabels(std::vector<NamedSurface>& surfaces, const std::string& mapFile)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(mapFile.c_str());
  reader->Update();
  const std::size_t crossing = JudgeIntersections(Together(surfaces)).Pairs;
  for (NamedSurface& surface : surfaces)
  {
    FindMisclassifiedVoxels(surface, reader->GetOutput());
    surface.Crossing = crossing;
  }
}

void Judge(const NamedSurface& surface)
{
  const TopologyVerdict topology = JudgeTopology(surface);
  const IntersectionVerdict intersections = JudgeIntersections(surface);
  const auto cavities = std::count_if(topology.Components.begin(), topology.Components.end(),
    [](double volume) { return volume < 0.; });
  std::cout << surface.Points.size() << ' ' << surface.Triangles.size() << ' ' << topology.Closed
            << ' ' << topology.Manifold << ' ' << topology.Oriented << ' ' << topology.Outward
            << ' ' << intersections.Pairs << ' ' << intersections.FlatTriangles << ' '
            << topology.UnusedPoints << ' ' << topology.Components.size() << ' '
            << topology.EulerCharacteristic << ' ' << topology.Genus << ' ' << topology.Area << ' '
            << topology.Volume;
  if (surface.Deltas.empty())
  {
    std::cout << " nan nan nan nan";
  }
  else
  {
    const LengthVerdict lengths = JudgeLengths(surface, surface.Deltas);
    std::cout << ' ' << lengths.Edges << ' ' << lengths.EdgesTooShort << ' ' << lengths.EdgesTooLong
              << ' ' << lengths.NearPairs;
  }
  const ShapeVerdict shapes = JudgeShapes(surface);
  std::cout << ' ' << shapes.Mean << ' ' << shapes.Quantile01 << ' ' << shapes.Least << ' '
            << cavities << ' ' << surface.Crossing << ' ' << surface.CentresOn << ' '
            << surface.MisclassifiedVoxels << std::endl;
}
}

int main(int count, char** words)
{
  if (count > 1 && std::string(words[1]) == "--help")
  {
    std::cout << "points triangles closed manifold oriented outward intersections flat unused "
                 "components euler genus area volume edges short long near ratio ratio01 "
                 "ratiomin cavities crossing on wrong\n";
    return 0;
  }
  std::cout << std::setprecision(17);
  const bool hasMap = count > 2 && std::string(words[1]) == "--map";
  try
  {
    std::vector<NamedSurface> surfaces;
    for (int i = hasMap ? 3 : 1; i < count; ++i)
    {
      surfaces.push_back(ReadSurface(words[i]));
    }
    if (hasMap)
    {
      JudgeLabels(surfaces, words[2]);
    }
    for (const NamedSurface& surface : surfaces)
    {
      Judge(surface);
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
