// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Judges surfaces in files, by CGAL and by what shares no code with Volumic: a line for each, words
 * and figures in the order of the line that --help prints.
 *
 *     JudgeFiles FILE.vtp...
 */

#include "SurfaceJudge.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <exception>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>

namespace
{
using namespace volumic::support;

TriangleSurface ReadSurface(const std::string& file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkPolyData* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !data)
  {
    throw std::invalid_argument("cannot be read");
  }
  if (data->GetNumberOfCells() != data->GetNumberOfPolys())
  {
    throw std::invalid_argument("has other cells than polygons");
  }
  TriangleSurface surface;
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
      throw std::invalid_argument("has polygons that are no triangles");
    }
    surface.Triangles.push_back(
      { static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]) });
  }
  return surface;
}

void Judge(const std::string& file)
{
  const TriangleSurface surface = ReadSurface(file);
  const TopologyVerdict topology = JudgeTopology(surface);
  const IntersectionVerdict intersections = JudgeIntersections(surface);
  std::cout << surface.Points.size() << ' ' << surface.Triangles.size() << ' ' << topology.Closed
            << ' ' << topology.Manifold << ' ' << topology.Oriented << ' ' << topology.Outward
            << ' ' << intersections.Pairs << ' ' << intersections.FlatTriangles << ' '
            << topology.UnusedPoints << ' ' << topology.Components.size() << ' '
            << topology.EulerCharacteristic << ' ' << topology.Genus << ' ' << topology.Area << ' '
            << topology.Volume << std::endl;
}
}

int main(int count, char** words)
{
  if (count > 1 && std::string(words[1]) == "--help")
  {
    std::cout << "points triangles closed manifold oriented outward intersections flat unused "
                 "components euler genus area volume\n";
    return 0;
  }
  std::cout << std::setprecision(17);
  for (int i = 1; i < count; ++i)
  {
    try
    {
      Judge(words[i]);
    }
    catch (const std::exception& error)
    {
      std::cerr << words[i] << ": " << error.what() << '\n';
      return 1;
    }
  }
  return 0;
}
