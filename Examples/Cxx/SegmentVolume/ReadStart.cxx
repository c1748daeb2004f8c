// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadStart.h"

#include "ParseNumbers.h"
#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSTLReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace tool
{
namespace
{
template <class Reader>
vtkSmartPointer<vtkPolyData> ReadWith(const std::string& name)
{
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  VtkMessages messages;
  messages.UpdateReader(reader, name);
  return reader->GetOutput();
}

std::string SuffixOf(const std::string& name)
{
  std::string suffix = std::filesystem::path(name).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

vtkSmartPointer<vtkPolyData> ReadMesh(const std::string& name)
{
  const std::string suffix = SuffixOf(name);
  if (!std::filesystem::exists(name))
  {
    throw Failure(name + ": no such file");
  }
  if (suffix == ".vtp")
  {
    return ReadWith<vtkXMLPolyDataReader>(name);
  }
  if (suffix == ".vtk")
  {
    return ReadWith<vtkPolyDataReader>(name);
  }
  if (suffix == ".stl")
  {
    return ReadWith<vtkSTLReader>(name);
  }
  if (suffix == ".ply")
  {
    return ReadWith<vtkPLYReader>(name);
  }
  if (suffix == ".obj")
  {
    return ReadWith<vtkOBJReader>(name);
  }
  throw Failure(name + ": .vtp, .vtk, .stl, .ply and .obj are read");
}

void ReadPointLines(const std::string& name, vtkPoints* points)
{
  std::ifstream file(name);
  if (!file)
  {
    throw Failure(name + ": cannot be opened");
  }
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
  {
    line.resize(std::min(line.find('#'), line.size()));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<std::string> texts;
    for (std::string word; words >> word;)
    {
      texts.push_back(word);
    }
    if (texts.empty())
    {
      continue;
    }
    try
    {
      if (texts.size() != 3)
      {
        throw UsageError("not three numbers");
      }
      points->InsertNextPoint(ParseNumber<double>(texts[0]), ParseNumber<double>(texts[1]),
        ParseNumber<double>(texts[2]));
    }
    catch (const UsageError& error)
    {
      if (number > 1)
      {
        throw Failure(name + ", line " + NumberText(number) + ": " + error.what());
      }
    }
  }
}
}

vtkSmartPointer<vtkPolyData> ReadSeeds(const std::string& name)
{
  const std::string suffix = SuffixOf(name);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  if (suffix == ".txt" || suffix == ".csv" || suffix == ".xyz")
  {
    ReadPointLines(name, points);
  }
  else
  {
    const vtkSmartPointer<vtkPolyData> mesh = ReadMesh(name);
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      points->InsertNextPoint(mesh->GetPoint(i));
    }
  }
  if (points->GetNumberOfPoints() == 0)
  {
    throw Failure(name + ": has no points");
  }
  auto seeds = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    vertices->InsertNextCell(1, &i);
  }
  seeds->SetPoints(points);
  seeds->SetVerts(vertices);
  return seeds;
}

vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& name)
{
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(ReadMesh(name));
  clean->SetTolerance(0.0);
  clean->Update();
  if (clean->GetOutput()->GetNumberOfPolys() == 0)
  {
    throw Failure(name + ": has no polygons");
  }
  return clean->GetOutput();
}
}
