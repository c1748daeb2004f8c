// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// MSH 2.2 (gmsh's reference manual, Legacy formats) and .inp (Abaqus's keywords *NODE, *ELEMENT,
// *ELSET, *NSET and *SURFACE, as CalculiX's manual has them).
#include "Tetrahedra.h"

#include "SurfaceFormats.h"
#include "Texts.h"
#include "VtkWriters.h"

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <locale>
#include <ostream>
#include <set>
#include <utility>

namespace tool
{
namespace
{
/** A face of a tetrahedron between two labels, or of a label and the outside, which is 0. */
struct Face
{
  vtkIdType Tetrahedron; ///< that of the smaller label, or the only one
  int Side;              ///< of the tetrahedron: opposite to this corner
};

using Pair = std::pair<int, int>;

/** The faces between two labels; outwards their corners are those of Sides. */
class SolidFaces
{
public:
  explicit SolidFaces(vtkUnstructuredGrid* grid);

  std::map<Pair, std::vector<Face>> Between;

  /** Of the tetrahedron, whose corners they are: seen from outside, counterclockwise. */
  std::array<vtkIdType, 3> CornersOf(const Face& face) const;

private:
  vtkUnstructuredGrid* Grid;
};

constexpr int Sides[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };

const vtkIdType* CornersIn(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkIdType count = 0;
  const vtkIdType* corners = nullptr;
  grid->GetCellPoints(cell, count, corners);
  return corners;
}

std::array<vtkIdType, 3> SolidFaces::CornersOf(const Face& face) const
{
  const vtkIdType* corners = CornersIn(this->Grid, face.Tetrahedron);
  const int* side = Sides[face.Side];
  return { corners[side[0]], corners[side[1]], corners[side[2]] };
}

const int* LabelsIn(vtkUnstructuredGrid* grid)
{
  return vtkIntArray::SafeDownCast(grid->GetCellData()->GetScalars())->GetPointer(0);
}

SolidFaces::SolidFaces(vtkUnstructuredGrid* grid) : Grid(grid)
{
  std::vector<std::pair<std::array<vtkIdType, 3>, Face>> faces; // by their corners in order
  faces.reserve(static_cast<std::size_t>(4 * grid->GetNumberOfCells()));
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    for (int side = 0; side < 4; ++side)
    {
      const Face face{ cell, side };
      std::array<vtkIdType, 3> corners = this->CornersOf(face);
      std::sort(corners.begin(), corners.end());
      faces.emplace_back(corners, face);
    }
  }
  std::sort(faces.begin(), faces.end(),
    [](const auto& a, const auto& b)
    {
      return std::make_pair(a.first, a.second.Tetrahedron) <
        std::make_pair(b.first, b.second.Tetrahedron);
    });
  const int* labels = LabelsIn(grid);
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const Face& face = faces[i].second;
    const int label = labels[face.Tetrahedron];
    if (i + 1 == faces.size() || faces[i + 1].first != faces[i].first)
    {
      this->Between[{ label, 0 }].push_back(face);
      continue;
    }
    const Face& other = faces[++i].second;
    const int beside = labels[other.Tetrahedron];
    if (label != beside)
    {
      this->Between[std::minmax(label, beside)].push_back(label < beside ? face : other);
    }
  }
}

/** What labels and pairs of them are called in a file, where a plain word is made of a name. */
class SetNames
{
public:
  SetNames(const Solid& solid, const SolidFaces& faces, const std::string& separator,
    const std::function<std::string(const std::string&)>& plain)
  {
    DistinctNames names(separator);
    for (const auto& [label, name] : solid.Names)
    {
      this->Labels[label] = names.Take(plain(name));
    }
    const std::string outside = names.Take("outside");
    for (const auto& entry : faces.Between)
    {
      const auto& [first, second] = entry.first;
      this->Pairs[entry.first] =
        names.Take(this->Labels[first] + "_to_" + (second == 0 ? outside : this->Labels[second]));
    }
    this->BoxFaces = { "x_min", "x_max", "y_min", "y_max", "z_min", "z_max" };
    for (std::string& name : this->BoxFaces)
    {
      name = names.Take(name);
    }
  }

  std::map<int, std::string> Labels;
  std::map<Pair, std::string> Pairs;
  std::array<std::string, 6> BoxFaces;
};

/** A set's name in Abaqus: it begins with a letter, and has 80 characters at most. */
std::string WordOf(const std::string& name)
{
  std::string word = name.substr(0, 30);
  std::replace_if(
    word.begin(), word.end(), [](unsigned char c) { return c > 127 || std::isalnum(c) == 0; }, '_');
  return word.empty() || std::isalpha(static_cast<unsigned char>(word[0])) == 0 ? "L_" + word
                                                                                : word;
}

/** A file of text, with a comma-separated list of numbers where one is. */
class InpFile
{
public:
  explicit InpFile(const std::string& path) : File(path), Out(&this->File)
  {
    this->Out.imbue(std::locale::classic());
    this->Out.precision(12); // CalculiX reads twenty characters of a number.
  }

  template <class Numbers>
  void WriteSet(const std::string& head, const Numbers& numbers)
  {
    this->Out << head << "\n";
    int inLine = 0;
    for (const vtkIdType number : numbers)
    {
      this->Out << (inLine == 0 ? "" : ", ") << number + 1;
      inLine = (inLine + 1) % 12;
      this->Out << (inLine == 0 ? ",\n" : "");
    }
    this->Out << (inLine == 0 ? "" : "\n");
  }

private:
  FileBuffer File;

public:
  std::ostream Out;

  void Finish()
  {
    this->Out.flush();
    this->File.Finish();
  }
};
}

void WriteInp(const Solid& solid, const std::string& path, const std::string& remark)
{
  // Abaqus's faces by the corner that is opposite: S1 has 1 2 3, S2 1 4 2, S3 2 4 3, S4 3 4 1.
  static const char* const sideNames[4] = { "S3", "S4", "S2", "S1" };
  vtkUnstructuredGrid* grid = solid.Grid;
  const SolidFaces faces(grid);
  const SetNames names(solid, faces, "_", WordOf);
  InpFile file(path);
  file.Out << "** " << remark << "\n*NODE, NSET=Nall\n";
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    const double* place = grid->GetPoint(point);
    file.Out << point + 1 << ", " << place[0] << ", " << place[1] << ", " << place[2] << "\n";
  }
  std::map<int, std::vector<vtkIdType>> cells;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    cells[LabelsIn(grid)[cell]].push_back(cell);
  }
  for (const auto& [label, name] : names.Labels)
  {
    std::set<vtkIdType> nodes;
    file.Out << "*ELEMENT, TYPE=C3D4, ELSET=" << name << "\n";
    for (const vtkIdType cell : cells[label])
    {
      const vtkIdType* corners = CornersIn(grid, cell);
      nodes.insert(corners, corners + 4);
      file.Out << cell + 1 << ", " << corners[0] + 1 << ", " << corners[1] + 1 << ", "
               << corners[2] + 1 << ", " << corners[3] + 1 << "\n";
    }
    file.WriteSet("*NSET, NSET=" + name, nodes);
  }
  file.Out << "*ELSET, ELSET=Eall\n";
  for (const auto& entry : names.Labels)
  {
    file.Out << entry.second << ",\n";
  }
  for (const auto& [pair, between] : faces.Between)
  {
    std::set<vtkIdType> nodes;
    const std::string& name = names.Pairs.at(pair);
    file.Out << "*SURFACE, NAME=" << name << ", TYPE=ELEMENT\n";
    for (const Face& face : between)
    {
      file.Out << face.Tetrahedron + 1 << ", " << sideNames[face.Side] << "\n";
      const std::array<vtkIdType, 3> corners = faces.CornersOf(face);
      nodes.insert(corners.begin(), corners.end());
    }
    file.WriteSet("*NSET, NSET=" + name, nodes);
  }
  for (std::size_t side = 0; side < solid.BoxNodes.size(); ++side)
  {
    if (!solid.BoxNodes[side].empty())
    {
      file.WriteSet("*NSET, NSET=" + names.BoxFaces[side], solid.BoxNodes[side]);
    }
  }
  file.Finish();
}

namespace
{
/**
 * Named surfaces: between two labels, of a label and the outside, and the sides of a box. A face is
 * in one of them only, as programs that read .msh want it: in a side, if it is in one.
 */
std::vector<std::pair<std::string, std::vector<Face>>> SurfacesOf(
  const Solid& solid, const SolidFaces& faces, const SetNames& names)
{
  std::vector<std::pair<std::string, std::vector<Face>>> surfaces;
  std::array<std::vector<Face>, 6> sides;
  for (const auto& [pair, between] : faces.Between)
  {
    std::vector<Face> others;
    for (const Face& face : between)
    {
      const std::array<vtkIdType, 3> corners = faces.CornersOf(face);
      const auto hasAll = [&](const std::set<vtkIdType>& nodes)
      {
        return std::all_of(corners.begin(), corners.end(),
          [&](vtkIdType corner) { return nodes.count(corner) > 0; });
      };
      const auto* side = std::find_if(solid.BoxNodes.begin(), solid.BoxNodes.end(), hasAll);
      const bool isInSide = pair.second == 0 && side != solid.BoxNodes.end();
      (isInSide ? sides[static_cast<std::size_t>(side - solid.BoxNodes.begin())] : others)
        .push_back(face);
    }
    surfaces.emplace_back(names.Pairs.at(pair), others);
  }
  for (std::size_t side = 0; side < sides.size(); ++side)
  {
    surfaces.emplace_back(names.BoxFaces[side], sides[side]);
  }
  surfaces.erase(std::remove_if(surfaces.begin(), surfaces.end(),
                   [](const auto& surface) { return surface.second.empty(); }),
    surfaces.end());
  return surfaces;
}
}

void WriteSolidMsh(const Solid& solid, const std::string& path, const std::string& remark)
{
  vtkUnstructuredGrid* grid = solid.Grid;
  const SolidFaces faces(grid);
  const SetNames names(solid, faces, " ", GmshWord);
  const int* labels = LabelsIn(grid);
  FileBuffer file(path);
  std::ostream out(&file);
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n" << remark << "\n$EndComments\n";
  const auto surfaces = SurfacesOf(solid, faces, names);
  out << "$PhysicalNames\n" << surfaces.size() + names.Labels.size() << "\n";
  int mark = 0;
  vtkIdType elements = grid->GetNumberOfCells();
  for (const auto& [name, found] : surfaces)
  {
    out << "2 " << ++mark << " \"" << name << "\"\n";
    elements += static_cast<vtkIdType>(found.size());
  }
  for (const auto& [label, name] : names.Labels)
  {
    out << "3 " << label << " \"" << name << "\"\n";
  }
  out << "$EndPhysicalNames\n$Nodes\n" << grid->GetNumberOfPoints() << "\n";
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    const double* place = grid->GetPoint(point);
    out << point + 1 << " " << place[0] << " " << place[1] << " " << place[2] << "\n";
  }
  out << "$EndNodes\n$Elements\n" << elements << "\n";
  vtkIdType element = 0;
  mark = 0;
  for (const auto& entry : surfaces)
  {
    ++mark;
    for (const Face& face : entry.second)
    {
      const std::array<vtkIdType, 3> corners = faces.CornersOf(face);
      out << ++element << " 2 2 " << mark << " " << mark << " " << corners[0] + 1 << " "
          << corners[1] + 1 << " " << corners[2] + 1 << "\n";
    }
  }
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const vtkIdType* corners = CornersIn(grid, cell);
    out << ++element << " 4 2 " << labels[cell] << " " << labels[cell] << " " << corners[0] + 1
        << " " << corners[1] + 1 << " " << corners[2] + 1 << " " << corners[3] + 1 << "\n";
  }
  out << "$EndElements\n";
  out.flush();
  file.Finish();
}
}
