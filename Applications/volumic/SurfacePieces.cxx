// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfacePieces.h"

#include "CheckWritten.h"
#include "OutputFiles.h"
#include "StreamedWriters.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <filesystem>
#include <locale>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

/** The corners of triangles, three of each. */
std::vector<vtkIdType> CornersOf(vtkPolyData* surface, vtkIdType begin, vtkIdType end)
{
  std::vector<vtkIdType> corners;
  corners.reserve(static_cast<std::size_t>(3 * (end - begin)));
  vtkNew<vtkIdList> triangle;
  for (vtkIdType t = begin; t < end; ++t)
  {
    surface->GetPolys()->GetCellAtId(t, triangle);
    corners.insert(corners.end(), triangle->begin(), triangle->end());
  }
  return corners;
}

/** Each point once, in their order. */
vtkSmartPointer<vtkIdTypeArray> PointsOf(const std::vector<vtkIdType>& corners)
{
  std::vector<vtkIdType> points = corners;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->SetName("GlobalIds");
  ids->SetNumberOfTuples(static_cast<vtkIdType>(points.size()));
  std::copy(points.begin(), points.end(), ids->GetPointer(0));
  return ids;
}

void SetTriangles(
  vtkPolyData* piece, const std::vector<vtkIdType>& corners, vtkIdTypeArray* pointsOfPiece)
{
  const auto size = static_cast<vtkIdType>(corners.size());
  const vtkIdType* points = pointsOfPiece->GetPointer(0);
  const vtkIdType* pointsEnd = points + pointsOfPiece->GetNumberOfTuples();
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfTuples(size / 3 + 1);
  for (vtkIdType t = 0; t <= size / 3; ++t)
  {
    offsets->SetValue(t, 3 * t);
  }
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfTuples(size);
  for (vtkIdType i = 0; i < size; ++i)
  {
    connectivity->SetValue(i, std::lower_bound(points, pointsEnd, corners[i]) - points);
  }
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets, connectivity);
  piece->SetPolys(triangles);
}

vtkSmartPointer<vtkPolyData> MakePiece(vtkPolyData* surface, vtkIdType begin, vtkIdType end)
{
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  const std::vector<vtkIdType> corners = CornersOf(surface, begin, end);
  const vtkSmartPointer<vtkIdTypeArray> ids = PointsOf(corners);
  SetTriangles(piece, corners, ids);

  const vtkIdType size = ids->GetNumberOfTuples();
  vtkNew<vtkIdList> from;
  vtkNew<vtkIdList> to;
  from->SetNumberOfIds(size);
  to->SetNumberOfIds(size);
  std::copy(ids->GetPointer(0), ids->GetPointer(0) + size, from->begin());
  std::iota(to->begin(), to->end(), vtkIdType(0));
  vtkNew<vtkPoints> points;
  points->SetDataType(surface->GetPoints()->GetDataType());
  surface->GetPoints()->GetPoints(from, points);
  piece->SetPoints(points);
  piece->GetPointData()->CopyAllocate(surface->GetPointData(), size);
  piece->GetPointData()->CopyData(surface->GetPointData(), from, to);
  piece->GetPointData()->SetGlobalIds(ids);
  piece->GetCellData()->CopyAllocate(surface->GetCellData(), end - begin);
  piece->GetCellData()->CopyData(surface->GetCellData(), 0, end - begin, begin);
  piece->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return piece;
}

//------------------------------------------------------------------------------
/** As a value of an attribute. */
std::string Escaped(const std::string& text)
{
  std::string escaped;
  for (const char c : text)
  {
    escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return escaped;
}

/** As VTK's XML files call the type of an array. */
std::string TypeName(vtkDataArray* array)
{
  const int type = array->GetDataType();
  const std::string kind = type == VTK_FLOAT || type == VTK_DOUBLE ? "Float"
    : array->GetDataTypeMin() < 0.0                                ? "Int"
                                                                   : "UInt";
  return kind + std::to_string(8 * array->GetDataTypeSize());
}

void Describe(std::ostream& os, vtkDataArray* array)
{
  os << "      <PDataArray type=\"" << TypeName(array) << "\" Name=\"" << Escaped(array->GetName())
     << "\" NumberOfComponents=\"" << array->GetNumberOfComponents() << "\"/>\n";
}

void Describe(
  std::ostream& os, const std::string& element, const std::string& roles, vtkFieldData* data)
{
  os << "    <" << element << roles << ">\n";
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    if (vtkDataArray* array = data->GetArray(i))
    {
      Describe(os, array);
    }
  }
  os << "    </" << element << ">\n";
}

/** What names the pieces, and tells what arrays they have: those of `piece`. */
std::string Summary(vtkPolyData* piece, const std::vector<std::string>& sources)
{
  std::ostringstream os;
  os.imbue(std::locale::classic());
  vtkDataArray* normals = piece->GetPointData()->GetNormals();
  const std::string roles = (normals ? " Normals=\"" + Escaped(normals->GetName()) + "\"" : "") +
    " GlobalIds=\"GlobalIds\"";
  os << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"0.1\">\n"
     << "  <PPolyData GhostLevel=\"0\">\n";
  Describe(os, "PPointData", roles, piece->GetPointData());
  Describe(os, "PCellData", "", piece->GetCellData());
  os << "    <PPoints>\n";
  Describe(os, piece->GetPoints()->GetData());
  os << "    </PPoints>\n";
  for (const std::string& source : sources)
  {
    os << "    <Piece Source=\"" << Escaped(source) << "\"/>\n";
  }
  os << "  </PPolyData>\n</VTKFile>\n";
  return os.str();
}
}

void WritePieces(vtkPolyData* surface, const std::string& path, int size, ProgressLine& line)
{
  const vtkIdType triangles = surface->GetNumberOfPolys();
  const fs::path folder = fs::path(path).replace_extension();
  const std::string stem = folder.filename().string();
  fs::create_directory(folder);
  std::vector<std::string> sources;
  vtkSmartPointer<vtkPolyData> piece;
  for (vtkIdType begin = 0; begin < triangles; begin += size)
  {
    line.Show(static_cast<double>(begin) / static_cast<double>(triangles), "");
    piece = MakePiece(surface, begin, std::min(triangles, begin + size));
    const std::string name = stem + "_" + std::to_string(sources.size()) + ".vtp";
    const std::string place = (folder / name).string();
    ProgressLine noLine("", ProgressStyle::None);
    WriteVtp(piece, place, noLine);
    CheckXml(place);
    sources.push_back(stem + "/" + name);
  }
  const std::string text = Summary(piece ? piece.Get() : surface, sources);
  WriteBytes(path, text.data(), text.size());
}
}
