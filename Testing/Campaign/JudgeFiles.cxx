// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Judges surfaces in files, by CGAL and by what shares no code with Volumic: a line for each, words
 * and figures in the order of the line that --help prints.
 *
 *     JudgeFiles [--map MAP.vti] FILE.vtp...
 *
 * Edges and pairs are judged by the deltas that the file tells (where it is graded, by those of its
 * points), which are world units only where the metric is World; without any they are "nan". Ratios
 * are radius ratios.
 *
 * With a map the files are surfaces of its labels, which their field data `Label` names: they are
 * judged against its voxels and against each other, too, and the numbers of the wrong voxels, x
 * fastest, end the line.
 */

#include "LabelJudge.h"
#include "SupportVtkConversions.h"
#include "SurfaceJudge.h"
#include "WrongVoxels.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <exception>
#include <iomanip>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
using namespace volumic::support;

/** A surface, and what there is to say of it if it is one of labels. */
struct NamedSurface : TriangleSurface
{
  std::set<double> Labels;
  std::vector<double> Deltas; ///< of the points; none where the file tells of none
  std::size_t TouchingPairs = 0;  ///< of triangles with all other files
  std::size_t VerticesInside = 0; ///< of the one inside the other, both ways
  std::vector<std::size_t> WrongVoxels;
};

NamedSurface ReadSurface(const std::string& file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !data)
  {
    throw std::invalid_argument(file + " cannot be read");
  }
  if (data->GetNumberOfCells() != data->GetNumberOfPolys())
  {
    throw std::invalid_argument(file + " has other cells than polygons");
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

void FindWrongVoxels(NamedSurface& surface, vtkImageData* map)
{
  TriangleSurface inIndices = surface;
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    map->TransformPhysicalPointToContinuousIndex(
      surface.Points[p].data(), inIndices.Points[p].data());
  }
  std::array<int, 3> size;
  map->GetDimensions(size.data());
  const std::vector<char> enclosed = EnclosedVoxels(inIndices, size);
  for (std::size_t v = 0; v < enclosed.size(); ++v)
  {
    const double label = map->GetPointData()->GetScalars()->GetTuple1(static_cast<vtkIdType>(v));
    if (surface.Labels.count(label) != static_cast<std::size_t>(enclosed[v]))
    {
      surface.WrongVoxels.push_back(v);
    }
  }
}

void JudgeLabels(std::vector<NamedSurface>& surfaces, const std::string& mapFile)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(mapFile.c_str());
  reader->Update();
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    FindWrongVoxels(surfaces[i], reader->GetOutput());
    for (std::size_t other = 0; other < i; ++other)
    {
      const OverlapVerdict overlap = JudgeOverlap(surfaces[i], surfaces[other]);
      for (const std::size_t one : { i, other })
      {
        surfaces[one].TouchingPairs += overlap.IntersectingPairs;
        surfaces[one].VerticesInside += overlap.VerticesInside;
      }
    }
  }
}

void Judge(const NamedSurface& surface)
{
  const TopologyVerdict topology = JudgeTopology(surface);
  const IntersectionVerdict intersections = JudgeIntersections(surface);
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
    std::cout << ' ' << lengths.Edges << ' ' << lengths.EdgesTooShort << ' '
              << lengths.EdgesTooLong << ' ' << lengths.NearPairs;
  }
  const ShapeVerdict shapes = JudgeShapes(surface);
  std::cout << ' ' << shapes.Mean << ' ' << shapes.Quantile01 << ' ' << shapes.Least << ' '
            << surface.TouchingPairs << ' ' << surface.VerticesInside << ' '
            << surface.WrongVoxels.size();
  for (const std::size_t voxel : surface.WrongVoxels)
  {
    std::cout << ' ' << voxel;
  }
  std::cout << std::endl;
}
}

int main(int count, char** words)
{
  if (count > 1 && std::string(words[1]) == "--help")
  {
    std::cout << "points triangles closed manifold oriented outward intersections flat unused "
                 "components euler genus area volume edges short long near ratio ratio01 "
                 "ratiomin touching overlapping wrong\n";
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
