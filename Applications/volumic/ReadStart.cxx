// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadStart.h"

#include "BinaryFile.h"
#include "CheckInputs.h"
#include "Messages.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSTLReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace tool
{
namespace
{
std::array<vtkCellArray*, 4> CellsOf(vtkPolyData* mesh)
{
  return { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() };
}

template <class Reader>
vtkSmartPointer<vtkPolyData> ReadWith(const std::string& name)
{
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  VtkMessages messages;
  messages.UpdateReader(reader, name);
  return reader->GetOutput();
}

/** Whether VTK's reader takes an STL file for text: of its begin hardly anything is binary. */
bool IsStlText(BinaryFile& file)
{
  const std::string head = file.Text(0, std::min<std::uint64_t>(file.Size(), 256));
  const auto signs = std::count_if(head.begin(), head.end(),
    [](char c) { return (c >= 0x20 && c <= 0x7F) || c == '\n' || c == '\r' || c == '\t'; });
  return 20 * (head.size() - static_cast<std::size_t>(signs)) < head.size();
}

/** STL; VTK's reader takes memory for as many triangles as a header tells of, be the file cut off.
 */
vtkSmartPointer<vtkPolyData> ReadStl(const std::string& name)
{
  BinaryFile file(name);
  const bool isText = file.Size() < 84 || IsStlText(file);
  const std::uint64_t triangles = isText ? 0 : file.Number(80, 4);
  FailIf(file.Size() < 84 + 50 * triangles,
    name + ": the file is cut off: it has " + std::to_string(file.Size()) +
      " bytes, its header asks for " + std::to_string(84 + 50 * triangles));
  return ReadWith<vtkSTLReader>(name);
}

/** What VTK's reader gives of a file that the check has let through. */
template <class Reader, void (*Check)(const std::string&)>
vtkSmartPointer<vtkPolyData> ReadChecked(const std::string& name)
{
  Named(name, [&] { Check(name); });
  return ReadWith<Reader>(name);
}

/** .vtp; of too few points of its polygons VTK's reader makes zeros. */
vtkSmartPointer<vtkPolyData> ReadXml(const std::string& name)
{
  const std::uint64_t told = Named(name, [&] { return CheckXmlInput(name); });
  const vtkSmartPointer<vtkPolyData> mesh = ReadWith<vtkXMLPolyDataReader>(name);
  vtkIdType there = 0;
  for (vtkCellArray* cells : CellsOf(mesh))
  {
    there += cells->GetNumberOfConnectivityIds();
  }
  FailIf(static_cast<std::uint64_t>(there) != told,
    name + ": the file is cut off or damaged: its cells have " + std::to_string(there) +
      " points, it holds " + std::to_string(told));
  return mesh;
}

vtkSmartPointer<vtkPolyData> ReadMeshFile(const std::string& name)
{
  using Read = vtkSmartPointer<vtkPolyData> (*)(const std::string&);
  static const std::map<std::string, Read> readers = { { ".vtp", ReadXml },
    { ".vtk", ReadChecked<vtkPolyDataReader, CheckLegacy> }, { ".stl", ReadStl },
    { ".ply", ReadChecked<vtkPLYReader, CheckPly> },
    { ".obj", ReadChecked<vtkOBJReader, CheckObj> } };
  FailIf(!std::filesystem::exists(name), name + ": no such file");
  return EntryOf(readers, SuffixOf(name), name + ": .vtp, .vtk, .stl, .ply and .obj are read")(
    name);
}

/** The mesh, whose cells have points that are there. */
vtkSmartPointer<vtkPolyData> ReadMesh(const std::string& name)
{
  vtkSmartPointer<vtkPolyData> mesh = ReadMeshFile(name);
  const vtkIdType points = mesh->GetNumberOfPoints();
  for (vtkCellArray* cells : CellsOf(mesh))
  {
    FailIf(!cells->IsValid(), name + ": is damaged: its cells overlap in the file");
    double range[2] = { 0.0, -1.0 };
    if (cells->GetNumberOfConnectivityIds() > 0)
    {
      cells->GetConnectivityArray()->GetRange(range, 0);
    }
    FailIf(range[0] < 0.0 || range[1] >= static_cast<double>(points),
      name + ": is damaged: a polygon has point " +
        NumberText(range[0] < 0.0 ? range[0] : range[1]) + ", there are " + std::to_string(points));
  }
  return mesh;
}

/** Points, and what comes with each. */
struct PointList
{
  vtkNew<vtkPoints> Points;
  vtkNew<vtkDoubleArray> Weights;
  vtkNew<vtkDoubleArray> Radii;
};

/** The words of a line, between blanks and commas, without a comment. */
std::vector<std::string> WordsOf(std::string line)
{
  line.resize(std::min(line.find('#'), line.size()));
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  std::vector<std::string> texts;
  for (std::string word; words >> word;)
  {
    texts.push_back(word);
  }
  return texts;
}

/** Whether these are names of columns, such as x, "y" or Weight: no numbers, mistyped or not. */
bool IsHeading(const std::vector<std::string>& words)
{
  const auto isName = [](const std::string& word)
  {
    std::string lower = Lower(word);
    lower.erase(std::remove(lower.begin(), lower.end(), '"'), lower.end());
    return !lower.empty() && std::isalpha(static_cast<unsigned char>(lower[0])) != 0 &&
      lower != "nan" && lower.compare(0, 3, "inf") != 0;
  };
  return std::all_of(words.begin(), words.end(), isName);
}

/** Lines of three numbers, or up to `columns`; the first that is not empty may be a heading. */
void ReadPointLines(const std::string& name, std::size_t columns, PointList& list)
{
  std::ifstream file(name);
  FailIf(!file, name + ": cannot be opened");
  std::string line;
  bool isFirst = true;
  for (int number = 1; std::getline(file, line); ++number)
  {
    const std::string mark = "\xEF\xBB\xBF"; // of UTF-8, which some programs write
    const bool isMarked = number == 1 && line.compare(0, mark.size(), mark) == 0;
    const std::vector<std::string> texts = WordsOf(isMarked ? line.substr(mark.size()) : line);
    if (texts.empty() || (isFirst && IsHeading(texts)))
    {
      isFirst = isFirst && texts.empty();
      continue;
    }
    isFirst = false;
    try
    {
      if (texts.size() < 3 || texts.size() > columns)
      {
        throw UsageError(columns == 3 ? "not three numbers" : "not three to five numbers");
      }
      std::vector<double> values = { 0.0, 0.0, 0.0, 1.0, 0.0 };
      std::transform(texts.begin(), texts.end(), values.begin(), ParseNumber<double>);
      list.Points->InsertNextPoint(values.data());
      list.Weights->InsertNextValue(values[3]);
      list.Radii->InsertNextValue(values[4]);
    }
    catch (const UsageError& error)
    {
      throw Failure(name + ", line " + NumberText(number) + ": " + error.what());
    }
  }
}

bool IsText(const std::string& name)
{
  const std::string suffix = SuffixOf(name);
  return suffix == ".txt" || suffix == ".csv" || suffix == ".xyz";
}

/** The points as vertices, without arrays. */
vtkSmartPointer<vtkPolyData> MakeVertices(vtkPoints* points, const std::string& name)
{
  FailIf(!points || points->GetNumberOfPoints() == 0, name + ": has no points");
  auto vertices = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkCellArray> cells;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    cells->InsertNextCell(1, &i);
  }
  vertices->SetPoints(points);
  vertices->SetVerts(cells);
  return vertices;
}
}

vtkSmartPointer<vtkPolyData> ReadSeeds(const std::string& name)
{
  if (!IsText(name))
  {
    return MakeVertices(ReadMesh(name)->GetPoints(), name);
  }
  PointList list;
  ReadPointLines(name, 3, list);
  return MakeVertices(list.Points, name);
}

vtkSmartPointer<vtkPolyData> ReadAttractingPoints(const std::string& name)
{
  if (!IsText(name))
  {
    const vtkSmartPointer<vtkPolyData> mesh = ReadMesh(name);
    const vtkSmartPointer<vtkPolyData> points = MakeVertices(mesh->GetPoints(), name);
    points->GetPointData()->ShallowCopy(mesh->GetPointData());
    return points;
  }
  PointList list;
  list.Weights->SetName("Weight");
  list.Radii->SetName("Radius");
  ReadPointLines(name, 5, list);
  const vtkSmartPointer<vtkPolyData> points = MakeVertices(list.Points, name);
  points->GetPointData()->AddArray(list.Weights);
  points->GetPointData()->AddArray(list.Radii);
  return points;
}

vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& name)
{
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(ReadMesh(name));
  clean->SetTolerance(0.0);
  clean->Update();
  FailIf(clean->GetOutput()->GetNumberOfPolys() == 0, name + ": has no polygons");
  return clean->GetOutput();
}
}
