// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What the JSON of a scene tells of the numbers behind it.
#include "GltfLayout.h"

#include "JsonWriter.h"
#include "SurfaceFields.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tool
{
namespace
{
/** Linear intensities, which glTF has, of those of a screen (sRGB). */
double Linear(double part)
{
  return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
}

/** An array of objects, the members of each by `describe`. */
template <class Items, class Describe>
void DescribeAll(JsonWriter& json, const char* name, const Items& items, const Describe& describe)
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
}

void GltfLayout::DescribeNodes(JsonWriter& json) const
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

void GltfLayout::DescribeMeshes(JsonWriter& json) const
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

void GltfLayout::DescribeMaterials(JsonWriter& json) const
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

void GltfLayout::DescribeNumbers(JsonWriter& json) const
{
  struct Numbers
  {
    int Piece;
    std::uint64_t Offset;
    std::uint64_t Count;
    GltfCode Type;
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

void GltfLayout::DescribePieces(JsonWriter& json) const
{
  std::uint64_t offset = 0;
  DescribeAll(json, "bufferViews", this->Pieces(),
    [&](const GltfPiece& piece)
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

std::string GltfLayout::Description() const
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
