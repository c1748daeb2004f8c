// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFormats.h"

#include "GltfScene.h"
#include "OutputFiles.h"
#include "SurfaceFacts.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkBYUWriter.h>
#include <vtkByteSwap.h>
#include <vtkDataArray.h>
#include <vtkFacetWriter.h>
#include <vtkHoudiniPolyDataWriter.h>
#include <vtkIVWriter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTriangle.h>
#include <vtkUnsignedCharArray.h>

#include <cstdint>
#include <iostream>
#include <locale>
#include <map>
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

template <class Writer>
void WriteWith(const SurfaceFile& file)
{
  vtkNew<Writer> writer;
  writer->SetInputData(file.Surface);
  writer->SetFileName(file.Path.c_str());
  RunWriter(writer.Get(), file.Line);
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

/** Places and normals of the corners, the most significant byte of a number first. */
void WriteTri(const SurfaceFile& file)
{
  vtkDataArray* normals = file.Surface->GetPointData()->GetNormals();
  FailIf(!normals,
    "cannot be written (No normals to write!: use vtkPolyDataNormals to generate them)");
  FileBuffer buffer(file.Path);
  std::ostream out(&buffer);
  ForEachPolygon(file.Surface,
    [&](vtkIdType triangle, const vtkIdType* corners, vtkIdType)
    {
      file.Line.Show(static_cast<double>(triangle) / static_cast<double>(TrianglesIn(file)), "");
      for (int k = 0; k < 3; ++k)
      {
        for (const double* numbers :
          { file.Surface->GetPoint(corners[k]), normals->GetTuple(corners[k]) })
        {
          vtkByteSwap::SwapWrite4BERange(AsFloats(numbers).data(), 3, &out);
        }
      }
    });
  buffer.Finish();
}

/**
 * On a full disk the writers of .iv and .g of VTK 9.6 destroy memory instead of telling. Texts have
 * numbers of six digits, and each point a colour, at most.
 */
void NeedRoomForText(const SurfaceFile& file)
{
  NeedRoom(file.Path, 1024 + 100 * PointsIn(file) + 64 * TrianglesIn(file));
}

void WriteByu(const SurfaceFile& file)
{
  NeedRoomForText(file);
  vtkNew<vtkBYUWriter> writer;
  writer->SetInputData(file.Surface);
  writer->SetGeometryFileName(file.Path.c_str());
  RunWriter(writer.Get(), file.Line);
}

/** VTK's writer counts what it has written on the standard output, where a report may go. */
void WriteFacet(const SurfaceFile& file)
{
  std::streambuf* output = std::cout.rdbuf(nullptr);
  try
  {
    WriteWith<vtkFacetWriter>(file);
  }
  catch (...)
  {
    std::cout.rdbuf(output);
    throw;
  }
  std::cout.rdbuf(output); // clears the errors too
}

void WriteScene(const SurfaceFile& file)
{
  const std::vector<SurfaceLabel> labels = LabelsOf(file.Surface);
  const std::string name = labels.size() == 1 ? labels.front().Name : "surface";
  WriteGlb({ { name, file.Surface } }, file.Path, file.Line);
}

/** A text of so many lines, one for so many points, and one for each triangle. */
template <int More, int PointsOfLine>
void CheckText(const SurfaceFile& file)
{
  CheckLines(
    file.Path, More + (PointsIn(file) + PointsOfLine - 1) / PointsOfLine + TrianglesIn(file));
}
}

const SurfaceFormat* FindSurfaceFormat(const std::string& name)
{
  using File = const SurfaceFile&;
  static const std::map<std::string, SurfaceFormat> formats = {
    { ".vtp", { [](File file) { WriteVtp(file.Surface, file.Path, file.Line); }, nullptr } },
    { ".pvtp", { WritePieces, nullptr } },
    { ".vtk",
      { [](File file) { WriteLegacy(file.Surface, file.Path, file.Remark, file.Line); }, nullptr } },
    { ".stl", { WriteStl, nullptr } },
    { ".ply", { WritePly, nullptr } },
    { ".glb", { WriteScene, nullptr } },
    { ".msh", { WriteMsh, nullptr } },
    { ".smesh", { WriteSmesh, nullptr } },
    { ".poly", { WritePoly, nullptr } },
    { ".obj", { WriteObj, nullptr } },
    { ".iv",
      { [](File file)
        {
          NeedRoomForText(file);
          WriteWith<vtkIVWriter>(file);
        },
        CheckText<14, 2> } },
    { ".g", { WriteByu, CheckText<2, 2> } },
    { ".geo", { WriteWith<vtkHoudiniPolyDataWriter>, CheckText<7, 1> } },
    { ".facet", { WriteFacet, CheckText<8, 1> } },
    { ".tri", { WriteTri, nullptr } },
  };
  const auto found = formats.find(SuffixOf(name));
  return found == formats.end() ? nullptr : &found->second;
}
}
