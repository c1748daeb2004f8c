// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFormats.h"

#include "OutputFiles.h"
#include "VtkWriters.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
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
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfTuples(size);
  for (vtkIdType i = 0; i < size; ++i)
  {
    connectivity->SetValue(i, std::lower_bound(points, pointsEnd, corners[i]) - points);
  }
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(3, connectivity);
  piece->SetPolys(triangles);
}

/** What the points are called in the whole surface, of which this one may be a part. */
void NameByWhole(vtkPolyData* surface, vtkIdTypeArray* points)
{
  if (vtkDataArray* ids = surface->GetPointData()->GetGlobalIds())
  {
    for (vtkIdType i = 0; i < points->GetNumberOfTuples(); ++i)
    {
      points->SetValue(i, static_cast<vtkIdType>(ids->GetComponent(points->GetValue(i), 0)));
    }
  }
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
  NameByWhole(surface, ids);
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

/** What is told of the arrays of a piece, which those of all pieces are. */
std::string DescribeArrays(vtkPolyData* piece)
{
  std::ostringstream os;
  os.imbue(std::locale::classic());
  vtkDataArray* normals = piece->GetPointData()->GetNormals();
  const std::string roles = (normals ? " Normals=\"" + Escaped(normals->GetName()) + "\"" : "") +
    " GlobalIds=\"GlobalIds\"";
  Describe(os, "PPointData", roles, piece->GetPointData());
  Describe(os, "PCellData", "", piece->GetCellData());
  os << "    <PPoints>\n";
  Describe(os, piece->GetPoints()->GetData());
  os << "    </PPoints>\n";
  return os.str();
}

std::string PieceName(const std::string& stem, int number)
{
  return stem + "_" + std::to_string(number) + ".vtp";
}

fs::path FolderOf(const std::string& path)
{
  return fs::path(path).replace_extension();
}
}

int NumberOfPieces(vtkPolyData* surface, int size)
{
  return static_cast<int>((surface->GetNumberOfPolys() + size - 1) / size);
}

std::string WritePieceFiles(const SurfaceFile& file, int first)
{
  const vtkIdType triangles = file.Surface->GetNumberOfPolys();
  const fs::path folder = FolderOf(file.Path);
  std::string arrays;
  for (vtkIdType begin = 0; begin < triangles; begin += file.PieceSize, ++first)
  {
    file.Line.Show(static_cast<double>(begin) / static_cast<double>(triangles), "");
    const vtkSmartPointer<vtkPolyData> piece =
      MakePiece(file.Surface, begin, std::min(triangles, begin + file.PieceSize));
    const std::string place = (folder / PieceName(folder.filename().string(), first)).string();
    ProgressLine noLine("", ProgressStyle::None);
    WriteVtp(piece, place, noLine);
    arrays = DescribeArrays(piece);
  }
  return arrays;
}

void WritePieceList(const std::string& path, const std::string& arrays, int pieces)
{
  const std::string stem = FolderOf(path).filename().string();
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"0.1\">\n"
                     "  <PPolyData GhostLevel=\"0\">\n" +
    arrays;
  for (int number = 0; number < pieces; ++number)
  {
    text += "    <Piece Source=\"" + Escaped(stem + "/" + PieceName(stem, number)) + "\"/>\n";
  }
  text += "  </PPolyData>\n</VTKFile>\n";
  WriteBytes(path, text.data(), text.size());
}

void WritePieces(const SurfaceFile& file)
{
  fs::create_directory(FolderOf(file.Path));
  const std::string arrays = WritePieceFiles(file, 0);
  WritePieceList(file.Path, arrays.empty() ? DescribeArrays(file.Surface) : arrays,
    NumberOfPieces(file.Surface, file.PieceSize));
}

void WriteVtm(vtkMultiBlockDataSet* blocks, const std::string& path, ProgressLine& line)
{
  const fs::path folder = FolderOf(path);
  const std::string stem = folder.filename().string();
  const unsigned int count = blocks->GetNumberOfBlocks();
  fs::create_directory(folder);
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" "
                     "version=\"1.0\">\n  <vtkMultiBlockDataSet>\n";
  for (unsigned int i = 0; i < count; ++i)
  {
    line.Show(static_cast<double>(i) / count, "");
    const bool hasName =
      blocks->HasMetaData(i) != 0 && blocks->GetMetaData(i)->Has(vtkCompositeDataSet::NAME()) != 0;
    text += "    <DataSet index=\"" + std::to_string(i) + "\"";
    text += hasName
      ? " name=\"" + Escaped(blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME())) + "\""
      : "";
    if (auto* surface = vtkPolyData::SafeDownCast(blocks->GetBlock(i)))
    {
      const std::string file = PieceName(stem, static_cast<int>(i));
      ProgressLine noLine("", ProgressStyle::None);
      WriteVtp(surface, (folder / file).string(), noLine);
      text += " file=\"" + Escaped(stem + "/" + file) + "\"";
    }
    text += "/>\n";
  }
  text += "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
  WriteBytes(path, text.data(), text.size());
}
}
