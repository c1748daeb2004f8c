// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFormats.h"

#include "SolidRegions.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkBoundingBox.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <locale>
#include <map>
#include <ostream>
#include <set>
#include <utility>
#include <vector>

namespace tool
{
std::string GmshWord(const std::string& name)
{
  std::string plain = Shortened(name, 50);
  std::replace(plain.begin(), plain.end(), '"', '\'');
  std::replace(plain.begin(), plain.end(), '\n', ' ');
  return plain;
}

namespace
{
using Pair = std::pair<int, int>;

/** The coordinates of a point in the fewest digits that tell its number, with blanks between. */
std::string PlaceText(vtkPoints* points, vtkIdType point)
{
  const double* place = points->GetPoint(point);
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
  {
    char digits[32];
    char* end = digits + sizeof(digits);
    char* last = points->GetDataType() == VTK_FLOAT
      ? std::to_chars(digits, end, static_cast<float>(place[axis])).ptr
      : std::to_chars(digits, end, place[axis]).ptr;
    text += (axis > 0 ? " " : "") + std::string(digits, last);
  }
  return text;
}

//------------------------------------------------------------------------------
/** The regions, and the numbers that files have for what is in them. */
class SolverModel
{
public:
  explicit SolverModel(vtkPolyData* surface);

  /** The number of a label: as it is, or one that no label has where that is not positive. */
  int NumberOf(int label) const { return this->Numbers[static_cast<std::size_t>(label)]; }
  /** No two things have the same, nor that of the outside, whatever labels are called. */
  const std::string& NameOf(int label) const { return this->Names.at(label); }
  const std::string& NameOf(const Pair& labels) const { return this->PairNames.at(labels); }
  int MarkOf(const SolidRegions::Triangle& triangle) const
  {
    return this->Marks.at(this->LabelsBeside({ triangle.Behind, triangle.InFront }));
  }
  /** Of region numbers; the outside of all labels, and cavities in them, are -1. */
  Pair LabelsBeside(const Pair& regions) const;

  vtkPoints* Points;
  SolidRegions Solids;
  std::map<Pair, int> Marks; ///< of pairs of labels

private:
  void MakeNames();

  std::vector<int> Numbers;
  std::map<int, std::string> Names;
  std::map<Pair, std::string> PairNames;
};

SolverModel::SolverModel(vtkPolyData* surface)
  : Points(surface->GetPoints()), Solids(FindRegions(surface))
{
  this->Numbers = SolidNumbers(this->Solids.Labels);
  for (const SolidRegions::Triangle& triangle : this->Solids.Triangles)
  {
    this->Marks[this->LabelsBeside({ triangle.Behind, triangle.InFront })] = 0;
  }
  int mark = 0;
  for (auto& entry : this->Marks)
  {
    entry.second = ++mark;
  }
  this->MakeNames();
}

Pair SolverModel::LabelsBeside(const Pair& regions) const
{
  const auto label = [this](int region)
  { return this->Solids.Regions[static_cast<std::size_t>(region)].Label; };
  return { label(regions.first), label(regions.second) };
}

void SolverModel::MakeNames()
{
  DistinctNames names(" ");
  int number = 0;
  for (const SurfaceLabel& label : this->Solids.Labels)
  {
    this->Names[number++] = names.Take(GmshWord(label.Name));
  }
  this->Names[-1] = names.Take("outside");
  for (const auto& entry : this->Marks)
  {
    const auto& [behind, inFront] = entry.first;
    this->PairNames[entry.first] = names.Take(this->Names[behind] + "_to_" + this->Names[inFront]);
  }
}

//------------------------------------------------------------------------------
/** A surface of gmsh's model: the triangles between two regions, and points that no earlier one
 * has. */
struct MshSurface
{
  int Number = 0;
  std::vector<std::size_t> Triangles = {};
  std::vector<vtkIdType> Points = {};
  vtkBoundingBox Box = {};
};

std::map<Pair, MshSurface> MshSurfaces(const SolverModel& model)
{
  std::map<Pair, MshSurface> surfaces;
  for (std::size_t t = 0; t < model.Solids.Triangles.size(); ++t)
  {
    const SolidRegions::Triangle& triangle = model.Solids.Triangles[t];
    surfaces[{ triangle.Behind, triangle.InFront }].Triangles.push_back(t);
  }
  std::vector<bool> isTaken(static_cast<std::size_t>(model.Points->GetNumberOfPoints()), false);
  int number = 0;
  for (auto& [regions, surface] : surfaces)
  {
    surface.Number = ++number;
    for (const std::size_t t : surface.Triangles)
    {
      for (const vtkIdType point : model.Solids.Triangles[t].Corners)
      {
        surface.Box.AddPoint(model.Points->GetPoint(point));
        const auto index = static_cast<std::size_t>(point);
        if (!isTaken[index])
        {
          surface.Points.push_back(point);
          isTaken[index] = true;
        }
      }
    }
  }
  return surfaces;
}

std::string BoxText(const vtkBoundingBox& box)
{
  std::string text;
  for (const double* corner : { box.GetMinPoint(), box.GetMaxPoint() })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      text += NumberText(corner[axis]) + " ";
    }
  }
  return text;
}

void WriteNames(std::ostream& out, const SolverModel& model, const std::set<int>& labels)
{
  out << "$PhysicalNames\n" << model.Marks.size() + labels.size() << "\n";
  for (const auto& [pair, mark] : model.Marks)
  {
    out << "2 " << mark << " \"" << model.NameOf(pair) << "\"\n";
  }
  for (const int label : labels)
  {
    out << "3 " << model.NumberOf(label) << " \"" << model.NameOf(label) << "\"\n";
  }
  out << "$EndPhysicalNames\n";
}

/** Surfaces and volumes, and what bounds these: with a minus where the normals point into it. */
void WriteEntities(std::ostream& out, const SolverModel& model,
  const std::map<Pair, MshSurface>& surfaces, std::size_t solids)
{
  out << "$Entities\n0 0 " << surfaces.size() << " " << solids << "\n";
  for (const auto& [regions, surface] : surfaces)
  {
    out << surface.Number << " " << BoxText(surface.Box) << "1 "
        << model.Marks.at(model.LabelsBeside(regions)) << " 0\n";
  }
  for (std::size_t region = 1; region <= solids; ++region)
  {
    vtkBoundingBox box;
    std::string bounds;
    int count = 0;
    for (const auto& [regions, surface] : surfaces)
    {
      const bool isBehind = regions.first == static_cast<int>(region);
      if (isBehind || regions.second == static_cast<int>(region))
      {
        box.AddBox(surface.Box);
        bounds += (isBehind ? " " : " -") + std::to_string(surface.Number);
        ++count;
      }
    }
    out << region << " " << BoxText(box) << "1 "
        << model.NumberOf(model.Solids.Regions[region].Label) << " " << count << bounds << "\n";
  }
  out << "$EndEntities\n";
}

/** @return the number of each point in the file */
std::vector<std::size_t> WriteNodes(
  std::ostream& out, const SolverModel& model, const std::map<Pair, MshSurface>& surfaces)
{
  std::vector<std::size_t> numbers(static_cast<std::size_t>(model.Points->GetNumberOfPoints()), 0);
  std::size_t last = 0;
  std::size_t blocks = 0;
  for (const auto& entry : surfaces)
  {
    blocks += entry.second.Points.empty() ? 0 : 1;
    for (const vtkIdType point : entry.second.Points)
    {
      numbers[static_cast<std::size_t>(point)] = ++last;
    }
  }
  out << "$Nodes\n" << blocks << " " << last << " 1 " << last << "\n";
  for (const auto& entry : surfaces)
  {
    const MshSurface& surface = entry.second;
    if (surface.Points.empty())
    {
      continue;
    }
    out << "2 " << surface.Number << " 0 " << surface.Points.size() << "\n";
    for (const vtkIdType point : surface.Points)
    {
      out << numbers[static_cast<std::size_t>(point)] << "\n";
    }
    for (const vtkIdType point : surface.Points)
    {
      out << PlaceText(model.Points, point) << "\n";
    }
  }
  out << "$EndNodes\n";
  return numbers;
}

void WriteElements(std::ostream& out, const SolverModel& model,
  const std::map<Pair, MshSurface>& surfaces, const std::vector<std::size_t>& numbers,
  ProgressLine& line)
{
  const std::size_t all = model.Solids.Triangles.size();
  out << "$Elements\n" << surfaces.size() << " " << all << " 1 " << all << "\n";
  std::size_t last = 0;
  for (const auto& entry : surfaces)
  {
    const MshSurface& surface = entry.second;
    line.Show(static_cast<double>(last) / static_cast<double>(all), "");
    out << "2 " << surface.Number << " 2 " << surface.Triangles.size() << "\n";
    for (const std::size_t t : surface.Triangles)
    {
      out << ++last;
      for (const vtkIdType point : model.Solids.Triangles[t].Corners)
      {
        out << " " << numbers[static_cast<std::size_t>(point)];
      }
      out << "\n";
    }
  }
  out << "$EndElements\n";
}

//------------------------------------------------------------------------------
/** Points that tell TetGen of regions: with labels or, of cavities, without. */
void WriteInside(std::ostream& out, const SolverModel& model, bool isSolid)
{
  std::string text;
  std::size_t count = 0;
  for (std::size_t region = 1; region < model.Solids.Regions.size(); ++region)
  {
    const SolidRegion& solid = model.Solids.Regions[region];
    if (model.Solids.IsSolid(region) == isSolid)
    {
      text += std::to_string(++count);
      for (const double coordinate : solid.Inside)
      {
        text += " " + NumberText(coordinate);
      }
      text += isSolid ? " " + std::to_string(model.NumberOf(solid.Label)) + " -1\n" : "\n";
    }
  }
  out << count << "\n" << text;
}

/** @param isPoly whether facets are told as .poly has them: polygons and holes of each */
void WriteTetgen(const SurfaceFile& to, bool isPoly)
{
  const SolverModel model(to.Surface);
  FileBuffer file(to.Path);
  std::ostream out(&file);
  out.imbue(std::locale::classic());
  out << "# " << to.Remark << "\n";
  for (std::size_t label = 0; label < model.Solids.Labels.size(); ++label)
  {
    const int index = static_cast<int>(label);
    out << "# region " << model.NumberOf(index) << ": " << model.NameOf(index) << "\n";
  }
  for (const auto& [pair, mark] : model.Marks)
  {
    out << "# facets " << mark << ": " << model.NameOf(pair) << "\n";
  }
  out << model.Points->GetNumberOfPoints() << " 3 0 0\n";
  for (vtkIdType point = 0; point < model.Points->GetNumberOfPoints(); ++point)
  {
    out << point + 1 << " " << PlaceText(model.Points, point) << "\n";
  }
  to.Line.Show(0.4, "");
  out << model.Solids.Triangles.size() << " 1\n";
  for (const SolidRegions::Triangle& triangle : model.Solids.Triangles)
  {
    const int mark = model.MarkOf(triangle);
    if (isPoly)
    {
      out << "1 0 " << mark << "\n";
    }
    out << 3;
    for (const vtkIdType point : triangle.Corners)
    {
      out << " " << point + 1;
    }
    out << (isPoly ? "" : " " + std::to_string(mark)) << "\n";
  }
  to.Line.Show(0.9, "");
  WriteInside(out, model, false);
  WriteInside(out, model, true);
  file.Finish();
}
}

void WriteMsh(const SurfaceFile& to)
{
  const SolverModel model(to.Surface);
  const std::map<Pair, MshSurface> surfaces = MshSurfaces(model);
  std::set<int> labels;
  std::size_t solids = 0; // which come first
  for (std::size_t region = 1; region < model.Solids.Regions.size(); ++region)
  {
    if (model.Solids.IsSolid(region))
    {
      labels.insert(model.Solids.Regions[region].Label);
      ++solids;
    }
  }
  FileBuffer file(to.Path);
  std::ostream out(&file);
  out.imbue(std::locale::classic());
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n" << to.Remark << "\n$EndComments\n";
  WriteNames(out, model, labels);
  WriteEntities(out, model, surfaces, solids);
  WriteElements(out, model, surfaces, WriteNodes(out, model, surfaces), to.Line);
  file.Finish();
}

void WriteSmesh(const SurfaceFile& to)
{
  WriteTetgen(to, false);
}

void WritePoly(const SurfaceFile& to)
{
  WriteTetgen(to, true);
}
}
