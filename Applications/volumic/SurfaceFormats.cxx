// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFormats.h"

#include "GltfScene.h"
#include "OutputFiles.h"
#include "SurfaceFacts.h"
#include "Tetrahedra.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkByteSwap.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTriangle.h>
#include <vtkUnsignedCharArray.h>

#include <cstdint>
#include <locale>
#include <map>
#include <ostream>
#include <vector>

namespace tool
{
namespace
{
std::uint64_t PointsIn(const SurfaceFile& file)
{
  return static_cast<std::uint64_t>(file.Surface->GetNumberOfPoints());
}

std::uint64_t TrianglesIn(const SurfaceFile& file)
{
  return static_cast<std::uint64_t>(file.Surface->GetNumberOfPolys());
}

/** Numbers of files that are binary, the least significant byte first. */
template <class Number>
void Put(std::ostream& out, const Number* numbers, std::size_t count)
{
  vtkByteSwap::SwapWrite4LERange(numbers, count, &out);
}

/** Binary: each triangle with its normal, its corners and two bytes for nothing. */
void WriteStl(const SurfaceFile& file)
{
  FileBuffer buffer(file.Path);
  std::ostream out(&buffer);
  const std::size_t headBytes = 80;
  std::string head = file.Remark;
  head.resize(headBytes, ' ');
  const auto triangles = static_cast<std::uint32_t>(TrianglesIn(file));
  out << head;
  Put(out, &triangles, 1);
  ForEachPolygon(file.Surface,
    [&](vtkIdType triangle, const vtkIdType* corners, vtkIdType count)
    {
      FailIf(count != 3, "cannot be written (STL file only supports triangles)");
      file.Line.Show(static_cast<double>(triangle) / triangles, "");
      double places[3][3];
      double normal[3];
      for (int k = 0; k < 3; ++k)
      {
        file.Surface->GetPoint(corners[k], places[k]);
      }
      vtkTriangle::ComputeNormal(places[0], places[1], places[2], normal);
      for (const double* numbers : { normal, places[0], places[1], places[2] })
      {
        Put(out, AsFloats(numbers).data(), 3);
      }
      out.write("\0\0", 2);
    });
  buffer.Finish();
}

/** Binary, with the colour of its label at each vertex, if there are labels. */
void WritePly(const SurfaceFile& file)
{
  const vtkSmartPointer<vtkUnsignedCharArray> colors = VertexColors(file.Surface);
  FileBuffer buffer(file.Path);
  std::ostream out(&buffer);
  out.imbue(std::locale::classic());
  out << "ply\nformat binary_little_endian 1.0\ncomment VTK generated PLY File\ncomment "
      << file.Remark << "\nobj_info vtkPolyData points and polygons: vtk4.0\nelement vertex "
      << PointsIn(file) << "\nproperty float x\nproperty float y\nproperty float z\n"
      << (colors ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "")
      << "element face " << TrianglesIn(file)
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (vtkIdType point = 0; point < file.Surface->GetNumberOfPoints(); ++point)
  {
    Put(out, AsFloats(file.Surface->GetPoint(point)).data(), 3);
    if (colors)
    {
      out.write(reinterpret_cast<const char*>(colors->GetPointer(3 * point)), 3);
    }
  }
  ForEachPolygon(file.Surface,
    [&](vtkIdType polygon, const vtkIdType* corners, vtkIdType count)
    {
      FailIf(count > 255, "cannot be written (Ply file only supports polygons with <256 points)");
      file.Line.Show(static_cast<double>(polygon) / static_cast<double>(TrianglesIn(file)), "");
      out.put(static_cast<char>(count));
      const std::vector<std::int32_t> numbers(corners, corners + count);
      Put(out, numbers.data(), numbers.size());
    });
  buffer.Finish();
}

/** A text: a line for each point, for its normal, and for each polygon. */
void WriteObj(const SurfaceFile& file)
{
  vtkDataArray* normals = file.Surface->GetPointData()->GetNormals();
  FileBuffer buffer(file.Path);
  std::ostream out(&buffer);
  out.imbue(std::locale::classic());
  out.precision(9); // As many as single precision has.
  out << "# " << file.Remark << "\n";
  const auto write = [&out](const char* kind, const double* numbers)
  { out << kind << " " << numbers[0] << " " << numbers[1] << " " << numbers[2] << "\n"; };
  for (vtkIdType point = 0; point < file.Surface->GetNumberOfPoints(); ++point)
  {
    write("v", file.Surface->GetPoint(point));
  }
  for (vtkIdType point = 0; normals && point < normals->GetNumberOfTuples(); ++point)
  {
    write("vn", normals->GetTuple(point));
  }
  ForEachPolygon(file.Surface,
    [&](vtkIdType polygon, const vtkIdType* corners, vtkIdType count)
    {
      file.Line.Show(static_cast<double>(polygon) / static_cast<double>(TrianglesIn(file)), "");
      out << "f";
      for (vtkIdType k = 0; k < count; ++k)
      {
        out << " " << corners[k] + 1;
        if (normals)
        {
          out << "//" << corners[k] + 1;
        }
      }
      out << "\n";
    });
  buffer.Finish();
}

void WriteScene(const SurfaceFile& file)
{
  const std::vector<SurfaceLabel> labels = LabelsOf(file.Surface);
  const std::string name = labels.size() == 1 ? labels.front().Name : "surface";
  const std::vector<SceneObject> objects = { { name, file.Surface } };
  SuffixOf(file.Path) == ".3mf" ? WriteThreeMf(objects, file.Path, file.Line)
                                : WriteGlb(objects, file.Path, file.Line);
}

const Solid& SolidOf(const SurfaceFile& file)
{
  return file.Solids->Make(file.Surface, file.Path, file.Line);
}
}

SurfaceWriter FindSurfaceWriter(const std::string& name)
{
  using File = const SurfaceFile&;
  static const std::map<std::string, SurfaceWriter> writers = {
    { ".vtp", [](File file) { WriteVtp(file.Surface, file.Path, file.Line); } },
    { ".pvtp", WritePieces },
    { ".vtk", [](File file) { WriteLegacy(file.Surface, file.Path, file.Remark, file.Line); } },
    { ".stl", WriteStl },
    { ".ply", WritePly },
    { ".glb", WriteScene },
    { ".3mf", WriteScene },
    { ".vtu", [](File file) { WriteVtu(SolidOf(file).Grid, file.Path, file.Line); } },
    { ".inp", [](File file) { WriteInp(SolidOf(file), file.Path, file.Remark); } },
    { ".msh",
      [](File file)
      {
        NeedsMesher(file.Path, file.Solids->Choice)
          ? WriteSolidMsh(SolidOf(file), file.Path, file.Remark)
          : WriteMsh(file);
      } },
    { ".smesh", WriteSmesh },
    { ".poly", WritePoly },
    { ".obj", WriteObj },
  };
  const auto found = writers.find(SuffixOf(name));
  return found == writers.end() ? nullptr : found->second;
}
}
