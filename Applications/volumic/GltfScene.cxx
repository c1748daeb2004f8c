// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GltfScene.h"

#include "FileBuffer.h"
#include "GltfLayout.h"
#include "ToolErrors.h"

#include <vtkBoundingBox.h>
#include <vtkByteSwap.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>

namespace tool
{
namespace
{
using Corners = std::vector<std::uint32_t>;

/** The corners of its triangles, those of each label together. */
std::map<int, Corners> CornersOf(vtkPolyData* surface)
{
  std::map<int, Corners> corners;
  const int* labels = TriangleLabels(surface);
  auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    cells->GetCurrentCell(count, points);
    Corners& own = corners[labels ? labels[cells->GetCurrentCellId()] : 0];
    own.insert(own.end(), points, points + count);
  }
  return corners;
}
}

GltfLayout::GltfLayout(const std::vector<SceneObject>& objects)
{
  vtkBoundingBox box;
  for (const SceneObject& object : objects)
  {
    if (object.Surface->GetNumberOfPoints() > 0)
    {
      box.AddBounds(object.Surface->GetBounds());
    }
  }
  if (!box.IsValid())
  {
    throw Failure("cannot be written (there is no surface)");
  }
  box.GetCenter(this->Middle.data());
  for (const SceneObject& object : objects)
  {
    if (object.Surface->GetNumberOfPoints() > 0)
    {
      this->Objects.push_back(this->Describe(object));
    }
  }
}

GltfLayout::Object GltfLayout::Describe(const SceneObject& object) const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Object described{ object.Name, object.Surface, object.Surface->GetPointData()->GetNormals(), {},
    { infinity, infinity, infinity }, { -infinity, -infinity, -infinity } };
  std::map<int, SurfaceLabel> known;
  for (const SurfaceLabel& label : LabelsOf(object.Surface))
  {
    known[label.Label] = label;
  }
  for (const auto& [label, corners] : CornersOf(object.Surface))
  {
    const auto found = known.find(label);
    const SurfaceLabel plain{ label, object.Name, { 0.8, 0.8, 0.8 } };
    described.Parts.push_back({ found == known.end() ? plain : found->second, corners.size() });
  }
  for (vtkIdType i = 0; i < object.Surface->GetNumberOfPoints(); ++i)
  {
    const std::array<float, 3> vertex = this->Vertex(object.Surface, i);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      described.Least[axis] = std::min(described.Least[axis], static_cast<double>(vertex[axis]));
      described.Most[axis] = std::max(described.Most[axis], static_cast<double>(vertex[axis]));
    }
  }
  return described;
}

std::array<float, 3> GltfLayout::Vertex(vtkPolyData* surface, vtkIdType point) const
{
  Vector3 place;
  surface->GetPoint(point, place.data());
  std::array<float, 3> vertex;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    vertex[axis] = static_cast<float>(place[axis] - this->Middle[axis]);
  }
  return vertex;
}

// ---- Bytes --------------------------------------------------------------------------------------

std::vector<GltfPiece> GltfLayout::Pieces() const
{
  std::vector<GltfPiece> pieces;
  for (const Object& object : this->Objects)
  {
    const auto vertices = static_cast<std::uint64_t>(12 * object.Surface->GetNumberOfPoints());
    pieces.insert(pieces.end(), object.Normals ? 2 : 1, GltfPiece{ vertices, OfVertices });
    pieces.push_back({ 0, OfCorners });
    for (const Part& part : object.Parts)
    {
      pieces.back().Bytes += 4 * part.Corners;
    }
  }
  return pieces;
}

std::uint64_t GltfLayout::Bytes() const
{
  std::uint64_t bytes = 0;
  for (const GltfPiece& piece : this->Pieces())
  {
    bytes += piece.Bytes;
  }
  return bytes;
}

void GltfLayout::WriteVertices(std::ostream& out, const Object& object) const
{
  const auto write = [&out](const std::array<float, 3>& numbers)
  { vtkByteSwap::SwapWrite4LERange(numbers.data(), 3, &out); };
  const vtkIdType count = object.Surface->GetNumberOfPoints();
  for (vtkIdType i = 0; i < count; ++i)
  {
    write(this->Vertex(object.Surface, i));
  }
  for (vtkIdType i = 0; object.Normals && i < count; ++i)
  {
    const double* normal = object.Normals->GetTuple3(i);
    write({ static_cast<float>(normal[0]), static_cast<float>(normal[1]),
      static_cast<float>(normal[2]) });
  }
}

void GltfLayout::Write(std::ostream& out, ProgressLine& line) const
{
  double done = 0.0;
  for (const Object& object : this->Objects)
  {
    line.Show(done++ / static_cast<double>(this->Objects.size()), object.Name);
    this->WriteVertices(out, object);
    for (const auto& [label, corners] : CornersOf(object.Surface))
    {
      vtkByteSwap::SwapWrite4LERange(corners.data(), corners.size(), &out);
    }
  }
}

void WriteGlb(const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line)
{
  const GltfLayout scene(objects);
  const std::string described = scene.Description();
  const std::uint64_t whole = 12 + 8 + described.size() + 8 + scene.Bytes();
  if (whole > std::numeric_limits<std::uint32_t>::max())
  {
    throw Failure("cannot be written (.glb holds no more than 4 GiB; write fewer surfaces, coarser "
                  "ones, or .vtp)");
  }
  FileBuffer file(path);
  std::ostream out(&file);
  const auto write = [&out](std::uint64_t number)
  {
    const auto word = static_cast<std::uint32_t>(number);
    vtkByteSwap::SwapWrite4LERange(&word, 1, &out);
  };
  for (const std::uint64_t number : { std::uint64_t(0x46546C67), std::uint64_t(2), whole,
         std::uint64_t(described.size()), std::uint64_t(0x4E4F534A) }) // "glTF", "JSON"
  {
    write(number);
  }
  out << described;
  write(scene.Bytes());
  write(0x004E4942); // "BIN"
  scene.Write(out, line);
  file.Finish();
}
}
