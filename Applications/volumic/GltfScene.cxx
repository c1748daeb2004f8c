// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GltfScene.h"

#include "FileBuffer.h"
#include "JsonWriter.h"
#include "LabelColors.h"
#include "Report.h"
#include "ToolErrors.h"

#include <vtkBoundingBox.h>
#include <vtkByteSwap.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>

namespace tool
{
namespace
{
using Corners = std::vector<std::uint32_t>;

/** Numbers of glTF and OpenGL. */
enum Code
{
  Float = 5126,
  UnsignedInt = 5125,
  OfVertices = 34962,
  OfCorners = 34963
};

/** Bytes of the file after another. */
struct Piece
{
  std::uint64_t Bytes;
  Code Use;
};

/** Linear intensities, which glTF has, of those of a screen (sRGB). */
double Linear(double part)
{
  return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
}

class Scene
{
public:
  explicit Scene(const std::vector<SceneObject>& objects);

  void Write(std::ostream& out, ProgressLine& line) const;
  /** What is told of the bytes behind it. */
  std::string Description() const;
  std::uint64_t Bytes() const;

private:
  /** A part of a mesh, of one material. */
  struct Part
  {
    SurfaceLabel Label;
    std::uint64_t Corners = 0;
  };
  struct Object
  {
    std::string Name;
    vtkPolyData* Surface;
    vtkDataArray* Normals; ///< null: none
    std::vector<Part> Parts; ///< that have triangles
    Vector3 Least;           ///< coordinates of vertices as they are written
    Vector3 Most;
  };

  Object Describe(const SceneObject& object) const;
  std::array<float, 3> Vertex(vtkPolyData* surface, vtkIdType point) const;
  /** Of each object vertices, normals if there are any, corners. */
  std::vector<Piece> Pieces() const;
  void WriteVertices(std::ostream& out, const Object& object) const;

  void DescribeNodes(JsonWriter& json) const;
  void DescribeMeshes(JsonWriter& json) const;
  void DescribeMaterials(JsonWriter& json) const;
  void DescribeNumbers(JsonWriter& json) const;
  void DescribePieces(JsonWriter& json) const;

  std::vector<Object> Objects;
  Vector3 Middle = { 0.0, 0.0, 0.0 };
};

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

Scene::Scene(const std::vector<SceneObject>& objects)
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

Scene::Object Scene::Describe(const SceneObject& object) const
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

std::array<float, 3> Scene::Vertex(vtkPolyData* surface, vtkIdType point) const
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

std::vector<Piece> Scene::Pieces() const
{
  std::vector<Piece> pieces;
  for (const Object& object : this->Objects)
  {
    const auto vertices = static_cast<std::uint64_t>(12 * object.Surface->GetNumberOfPoints());
    pieces.insert(pieces.end(), object.Normals ? 2 : 1, Piece{ vertices, OfVertices });
    pieces.push_back({ 0, OfCorners });
    for (const Part& part : object.Parts)
    {
      pieces.back().Bytes += 4 * part.Corners;
    }
  }
  return pieces;
}

std::uint64_t Scene::Bytes() const
{
  std::uint64_t bytes = 0;
  for (const Piece& piece : this->Pieces())
  {
    bytes += piece.Bytes;
  }
  return bytes;
}

void Scene::WriteVertices(std::ostream& out, const Object& object) const
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

void Scene::Write(std::ostream& out, ProgressLine& line) const
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

// ---- What is told of them -----------------------------------------------------------------------

/** An array of objects, the members of each by `describe`. */
template <class Items, class Describe>
void DescribeAll(
  JsonWriter& json, const char* name, const Items& items, const Describe& describe)
{
  json.Name(name);
  json.BeginArray();
  for (const auto& item : items)
  {
    json.BeginObject();
    describe(item);
    json.EndObject();
  }
  json.EndArray();
}

void Scene::DescribeNodes(JsonWriter& json) const
{
  struct Node
  {
    const Object* Shown; ///< null: that about all
    double Place;
  };
  std::vector<Node> nodes = { { nullptr, 0.0 } };
  std::vector<double> children;
  for (const Object& object : this->Objects)
  {
    children.push_back(static_cast<double>(nodes.size()));
    nodes.push_back({ &object, children.back() - 1.0 });
  }
  // A quarter turn about x: z becomes y, and y becomes -z.
  const double half = std::sqrt(0.5);
  const double turn[4] = { -half, 0.0, 0.0, half };
  const double shift[3] = { this->Middle[0], this->Middle[2], -this->Middle[1] };
  DescribeAll(json, "nodes", nodes,
    [&](const Node& node)
    {
      if (!node.Shown)
      {
        json.Numbers("children", children.data(), static_cast<int>(children.size()));
        json.Numbers("rotation", turn, 4);
        json.Numbers("translation", shift, 3);
        return;
      }
      std::vector<double> labels;
      for (const SurfaceLabel& label : LabelsOf(node.Shown->Surface))
      {
        labels.push_back(label.Label);
      }
      json.Member("name", node.Shown->Name);
      json.Member("mesh", node.Place);
      json.Name("extras");
      json.BeginObject();
      json.Numbers("labels", labels.data(), static_cast<int>(labels.size()));
      json.Member("stop_reason", StopReason(node.Shown->Surface));
      json.EndObject();
    });
}

void Scene::DescribeMeshes(JsonWriter& json) const
{
  int numbers = 0;
  int material = 0;
  DescribeAll(json, "meshes", this->Objects,
    [&](const Object& object)
    {
      const int vertices = numbers;
      numbers += object.Normals ? 2 : 1;
      json.Member("name", object.Name);
      DescribeAll(json, "primitives", object.Parts,
        [&](const Part&)
        {
          json.Name("attributes");
          json.BeginObject();
          json.Member("POSITION", vertices);
          if (object.Normals)
          {
            json.Member("NORMAL", vertices + 1);
          }
          json.EndObject();
          json.Member("indices", numbers++);
          json.Member("material", material++);
        });
    });
}

void Scene::DescribeMaterials(JsonWriter& json) const
{
  std::vector<SurfaceLabel> materials;
  for (const Object& object : this->Objects)
  {
    for (const Part& part : object.Parts)
    {
      materials.push_back(part.Label);
    }
  }
  DescribeAll(json, "materials", materials,
    [&](const SurfaceLabel& material)
    {
      std::array<double, 4> color = { 0.0, 0.0, 0.0, 1.0 };
      std::transform(material.Color.begin(), material.Color.end(), color.begin(), Linear);
      json.Member("name", material.Name);
      json.Name("pbrMetallicRoughness");
      json.BeginObject();
      json.Numbers("baseColorFactor", color.data(), 4);
      json.Member("metallicFactor", 0);
      json.Member("roughnessFactor", 0.6);
      json.EndObject();
    });
}

void Scene::DescribeNumbers(JsonWriter& json) const
{
  struct Numbers
  {
    int Piece;
    std::uint64_t Offset;
    std::uint64_t Count;
    Code Type;
    const Object* Bounded; ///< null: they have no bounds
  };
  std::vector<Numbers> all;
  int piece = 0;
  for (const Object& object : this->Objects)
  {
    const auto vertices = static_cast<std::uint64_t>(object.Surface->GetNumberOfPoints());
    all.push_back({ piece++, 0, vertices, Float, &object });
    if (object.Normals)
    {
      all.push_back({ piece++, 0, vertices, Float, nullptr });
    }
    std::uint64_t offset = 0;
    for (const Part& part : object.Parts)
    {
      all.push_back({ piece, offset, part.Corners, UnsignedInt, nullptr });
      offset += 4 * part.Corners;
    }
    ++piece;
  }
  DescribeAll(json, "accessors", all,
    [&](const Numbers& numbers)
    {
      json.Member("bufferView", numbers.Piece);
      json.Member("byteOffset", static_cast<double>(numbers.Offset));
      json.Member("componentType", static_cast<int>(numbers.Type));
      json.Member("count", static_cast<double>(numbers.Count));
      json.Member("type", numbers.Type == Float ? "VEC3" : "SCALAR");
      if (numbers.Bounded)
      {
        json.Numbers("min", numbers.Bounded->Least.data(), 3);
        json.Numbers("max", numbers.Bounded->Most.data(), 3);
      }
    });
}

void Scene::DescribePieces(JsonWriter& json) const
{
  std::uint64_t offset = 0;
  DescribeAll(json, "bufferViews", this->Pieces(),
    [&](const Piece& piece)
    {
      json.Member("buffer", 0);
      json.Member("byteOffset", static_cast<double>(offset));
      json.Member("byteLength", static_cast<double>(piece.Bytes));
      json.Member("target", static_cast<int>(piece.Use));
      offset += piece.Bytes;
    });
  DescribeAll(json, "buffers", std::vector<std::uint64_t>{ this->Bytes() },
    [&](std::uint64_t bytes) { json.Member("byteLength", static_cast<double>(bytes)); });
}

std::string Scene::Description() const
{
  std::ostringstream text;
  JsonWriter json(text);
  json.BeginObject();
  json.Name("asset");
  json.BeginObject();
  json.Member("version", "2.0");
  json.Member("generator", "volumic " VOLUMIC_VERSION);
  json.EndObject();
  json.Member("scene", 0);
  DescribeAll(json, "scenes", std::vector<double>{ 0.0 },
    [&](double node) { json.Numbers("nodes", &node, 1); });
  this->DescribeNodes(json);
  this->DescribeMeshes(json);
  this->DescribeMaterials(json);
  this->DescribeNumbers(json);
  this->DescribePieces(json);
  json.EndObject();
  std::string described = text.str();
  described.resize((described.size() + 3) / 4 * 4, ' ');
  return described;
}
}

void WriteGlb(const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line)
{
  const Scene scene(objects);
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
