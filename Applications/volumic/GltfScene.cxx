// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GltfScene.h"

#include "Json.h"
#include "SurfaceFacts.h"
#include "ToolErrors.h"
#include "VolumeImage.h"
#include "VtkWriters.h"

#include <vtkBoundingBox.h>
#include <vtkByteSwap.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <ostream>

namespace tool
{
namespace
{
/** Numbers of glTF and OpenGL. */
enum GltfCode
{
  Float = 5126,
  UnsignedInt = 5125,
  OfVertices = 34962,
  OfCorners = 34963
};

using Corners = std::vector<std::uint32_t>;

/** The corners of its triangles, those of each label together. */
std::map<int, Corners> CornersOf(vtkPolyData* surface)
{
  std::map<int, Corners> corners;
  const int* labels = TriangleLabels(surface);
  ForEachPolygon(surface,
    [&](vtkIdType polygon, const vtkIdType* points, vtkIdType count)
    {
      Corners& own = corners[labels ? labels[polygon] : 0];
      own.insert(own.end(), points, points + count);
    });
  return corners;
}

/** Linear intensities, which glTF has, of those of a screen (sRGB). */
double Linear(double part)
{
  return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
}

Json MaterialOf(const SurfaceLabel& label)
{
  std::array<double, 4> color = { 0.0, 0.0, 0.0, 1.0 };
  std::transform(label.Color.begin(), label.Color.end(), color.begin(), Linear);
  return { { "name", label.Name },
    { "pbrMetallicRoughness",
      { { "baseColorFactor", color }, { "metallicFactor", 0 }, { "roughnessFactor", 0.6 } } } };
}

//------------------------------------------------------------------------------
/** What a scene of glTF holds: numbers one after another, and what is told of them. */
class Scene
{
public:
  explicit Scene(const std::vector<SceneObject>& objects);

  /** What is told of the bytes behind it. */
  std::string Description() const;
  std::uint64_t Bytes() const { return this->End; }
  void Write(std::ostream& out, ProgressLine& line) const;

private:
  void Describe(const SceneObject& object);
  Json DescribeParts(const SceneObject& object, const Json& attributes);
  Json DescribeVertices(vtkPolyData* surface);
  std::size_t AddPiece(std::uint64_t bytes, GltfCode use);
  std::size_t AddNumbers(
    std::size_t piece, std::uint64_t offset, std::uint64_t count, GltfCode type);

  Floats Vertex(vtkPolyData* surface, vtkIdType point) const;
  void WriteVertices(std::ostream& out, vtkPolyData* surface) const;

  std::vector<SceneObject> Objects; ///< that have points
  Vector3 Middle = { 0.0, 0.0, 0.0 };
  Json Told;             ///< Its members are there from the begin: a new one would move the others.
  std::uint64_t End = 0; ///< of the numbers
};

Scene::Scene(const std::vector<SceneObject>& objects)
{
  std::copy_if(objects.begin(), objects.end(), std::back_inserter(this->Objects),
    [](const SceneObject& object) { return object.Surface->GetNumberOfPoints() > 0; });
  FailIf(this->Objects.empty(), "cannot be written (there is no surface)");
  vtkBoundingBox box;
  std::vector<std::size_t> children(this->Objects.size());
  for (std::size_t i = 0; i < children.size(); ++i)
  {
    box.AddBounds(this->Objects[i].Surface->GetBounds());
    children[i] = i + 1;
  }
  box.GetCenter(this->Middle.data());
  // A quarter turn about x: z becomes y, and y becomes -z.
  const double half = std::sqrt(0.5);
  const Vector3 shift = { this->Middle[0], this->Middle[2], -this->Middle[1] };
  this->Told = { { "asset", { { "version", "2.0" }, { "generator", "volumic " VOLUMIC_VERSION } } },
    { "scene", 0 }, { "scenes", Json::array({ { { "nodes", Json::array({ 0 }) } } }) },
    { "nodes",
      Json::array({ { { "children", children }, { "rotation", { -half, 0.0, 0.0, half } },
        { "translation", shift } } }) },
    { "meshes", Json::array() }, { "materials", Json::array() }, { "accessors", Json::array() },
    { "bufferViews", Json::array() } };
  for (const SceneObject& object : this->Objects)
  {
    this->Describe(object);
  }
  this->Told["buffers"] = Json::array({ { { "byteLength", this->End } } });
}

/** A node and a mesh. */
void Scene::Describe(const SceneObject& object)
{
  std::vector<int> labels;
  for (const SurfaceLabel& label : LabelsOf(object.Surface))
  {
    labels.push_back(label.Label);
  }
  Json extras = { { "labels", labels }, { "stop_reason", StopReason(object.Surface) } };
  for (const char* fact : { "SPACE", "LengthUnit" }) // as MarkSpace has them
  {
    if (const std::string text = GetFact(object.Surface, fact); !text.empty())
    {
      extras[fact] = text;
    }
  }
  this->Told["nodes"].push_back(
    { { "name", object.Name }, { "mesh", this->Told["meshes"].size() }, { "extras", extras } });
  const Json attributes = this->DescribeVertices(object.Surface);
  this->Told["meshes"].push_back(
    { { "name", object.Name }, { "primitives", this->DescribeParts(object, attributes) } });
}

/** Their positions, and normals if there are any. */
Json Scene::DescribeVertices(vtkPolyData* surface)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector3 least = { infinity, infinity, infinity };
  Vector3 most = { -infinity, -infinity, -infinity };
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const Floats vertex = this->Vertex(surface, i);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      least[axis] = std::min(least[axis], static_cast<double>(vertex[axis]));
      most[axis] = std::max(most[axis], static_cast<double>(vertex[axis]));
    }
  }
  const auto count = static_cast<std::uint64_t>(surface->GetNumberOfPoints());
  const auto add = [&]
  { return this->AddNumbers(this->AddPiece(12 * count, OfVertices), 0, count, Float); };
  Json attributes = { { "POSITION", add() } };
  this->Told["accessors"].back()["min"] = least;
  this->Told["accessors"].back()["max"] = most;
  if (surface->GetPointData()->GetNormals())
  {
    attributes["NORMAL"] = add();
  }
  return attributes;
}

/** The triangles of each label, with a material of its own. */
Json Scene::DescribeParts(const SceneObject& object, const Json& attributes)
{
  std::map<int, SurfaceLabel> known;
  for (const SurfaceLabel& label : LabelsOf(object.Surface))
  {
    known[label.Label] = label;
  }
  const auto all =
    static_cast<std::uint64_t>(object.Surface->GetPolys()->GetNumberOfConnectivityIds());
  const std::size_t piece = this->AddPiece(4 * all, OfCorners);
  Json parts = Json::array();
  std::uint64_t offset = 0;
  for (const auto& [label, corners] : CornersOf(object.Surface))
  {
    const SurfaceLabel plain{ label, object.Name, { 0.8, 0.8, 0.8 } };
    parts.push_back({ { "attributes", attributes },
      { "indices", this->AddNumbers(piece, offset, corners.size(), UnsignedInt) },
      { "material", this->Told["materials"].size() } });
    this->Told["materials"].push_back(MaterialOf(known.count(label) > 0 ? known[label] : plain));
    offset += 4 * corners.size();
  }
  return parts;
}

/** @return which piece these bytes are, which come behind those before. */
std::size_t Scene::AddPiece(std::uint64_t bytes, GltfCode use)
{
  Json& pieces = this->Told["bufferViews"];
  pieces.push_back(
    { { "buffer", 0 }, { "byteOffset", this->End }, { "byteLength", bytes }, { "target", use } });
  this->End += bytes;
  return pieces.size() - 1;
}

/** @return which of all numbers these are, in a piece. */
std::size_t Scene::AddNumbers(
  std::size_t piece, std::uint64_t offset, std::uint64_t count, GltfCode type)
{
  Json& all = this->Told["accessors"];
  all.push_back({ { "bufferView", piece }, { "byteOffset", offset }, { "componentType", type },
    { "count", count }, { "type", type == Float ? "VEC3" : "SCALAR" } });
  return all.size() - 1;
}

std::string Scene::Description() const
{
  std::string described = TextOf(this->Told, -1);
  described.resize((described.size() + 3) / 4 * 4, ' ');
  return described;
}

Floats Scene::Vertex(vtkPolyData* surface, vtkIdType point) const
{
  Vector3 place;
  surface->GetPoint(point, place.data());
  std::transform(place.begin(), place.end(), this->Middle.begin(), place.begin(), std::minus<>());
  return AsFloats(place.data());
}

void Scene::WriteVertices(std::ostream& out, vtkPolyData* surface) const
{
  const auto write = [&out](const Floats& numbers)
  { vtkByteSwap::SwapWrite4LERange(numbers.data(), 3, &out); };
  const vtkIdType count = surface->GetNumberOfPoints();
  for (vtkIdType i = 0; i < count; ++i)
  {
    write(this->Vertex(surface, i));
  }
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  for (vtkIdType i = 0; normals && i < count; ++i)
  {
    write(AsFloats(normals->GetTuple3(i)));
  }
}

void Scene::Write(std::ostream& out, ProgressLine& line) const
{
  double done = 0.0;
  for (const SceneObject& object : this->Objects)
  {
    line.Show(done++ / static_cast<double>(this->Objects.size()), object.Name);
    this->WriteVertices(out, object.Surface);
    for (const auto& [label, corners] : CornersOf(object.Surface))
    {
      vtkByteSwap::SwapWrite4LERange(corners.data(), corners.size(), &out);
    }
  }
}
}

void WriteGlb(const std::vector<SceneObject>& objects, const std::string& path, ProgressLine& line)
{
  const Scene scene(objects);
  const std::string described = scene.Description();
  const std::uint64_t whole = 12 + 8 + described.size() + 8 + scene.Bytes();
  FailIf(whole > std::numeric_limits<std::uint32_t>::max(),
    "cannot be written (.glb holds no more than 4 GiB; write fewer surfaces, coarser "
    "ones, or .vtp)");
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
