// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Judges surfaces in files, by CGAL and by what shares no code with Volumic: a line for each, words
 * and figures in the order of the line that --help prints.
 *
 *     JudgeFiles [--map MAP.vti] FILE.vtp...
 *
 * With a map the files are surfaces of its labels, which their field data `Label` names: they are
 * judged against its voxels and against each other, too, and the numbers of the wrong voxels, x
 * fastest, end the line.
 */

#include "LabelJudge.h"
#include "SurfaceJudge.h"
#include "WrongVoxels.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
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
  vtkDataArray* labels = data->GetFieldData()->GetArray("Label");
  for (vtkIdType i = 0; labels && i < labels->GetNumberOfTuples(); ++i)
  {
    surface.Labels.insert(labels->GetComponent(i, 0));
  }
  surface.Points.resize(data->GetNumberOfPoints());
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    data->GetPoint(static_cast<vtkIdType>(p), surface.Points[p].data());
  }
  const auto faces = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (faces->GoToFirstCell(); !faces->IsDoneWithTraversal(); faces->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* corners;
    faces->GetCurrentCell(size, corners);
    if (size != 3)
    {
      throw std::invalid_argument(file + " has polygons that are no triangles");
    }
    surface.Triangles.push_back(
      { static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]) });
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
            << topology.Volume << ' ' << surface.TouchingPairs << ' ' << surface.VerticesInside
            << ' ' << surface.WrongVoxels.size();
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
                 "components euler genus area volume touching overlapping wrong\n";
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
