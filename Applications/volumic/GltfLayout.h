// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGltfLayout_h
#define volumicGltfLayout_h

#include "GltfScene.h"
#include "SurfaceFields.h"

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

class vtkDataArray;

namespace tool
{
class JsonWriter;

/** Numbers of glTF and OpenGL. */
enum GltfCode
{
  Float = 5126,
  UnsignedInt = 5125,
  OfVertices = 34962,
  OfCorners = 34963
};

/** Bytes of the file after another. */
struct GltfPiece
{
  std::uint64_t Bytes;
  GltfCode Use;
};

/** What a scene of glTF holds: numbers one after another, and what is told of them. */
class GltfLayout
{
public:
  explicit GltfLayout(const std::vector<SceneObject>& objects);

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
    vtkDataArray* Normals;   ///< null: none
    std::vector<Part> Parts; ///< that have triangles
    Vector3 Least;           ///< coordinates of vertices as they are written
    Vector3 Most;
  };

  Object Describe(const SceneObject& object) const;
  std::array<float, 3> Vertex(vtkPolyData* surface, vtkIdType point) const;
  /** Of each object vertices, normals if there are any, corners. */
  std::vector<GltfPiece> Pieces() const;
  void WriteVertices(std::ostream& out, const Object& object) const;

  void DescribeNodes(JsonWriter& json) const;
  void DescribeMeshes(JsonWriter& json) const;
  void DescribeMaterials(JsonWriter& json) const;
  void DescribeNumbers(JsonWriter& json) const;
  void DescribePieces(JsonWriter& json) const;

  std::vector<Object> Objects;
  Vector3 Middle = { 0.0, 0.0, 0.0 };
};
}

#endif
