// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCapMesh_h
#define volumicCapMesh_h

#include <vtkType.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

class vtkPolyData;

namespace tool
{
/**
 * Flat triangles that close a surface, from long ones, with points at their rims only, to even
 * ones: edges between two of them are split, and flipped where they are in one plane, and points
 * within a plane go to between their neighbours. Edges of the surface stay, all stays in its plane,
 * and turns over nowhere: so nothing can cross anything.
 */
class CapMesh
{
public:
  struct Triangle
  {
    std::array<vtkIdType, 3> Corners; ///< counterclockwise seen from outside
    int Plane;
  };

  /** @param surface gets points, with what others have, but no cells */
  CapMesh(vtkPolyData* surface, std::vector<Triangle> triangles);

  /** @param length of edges, about */
  void MakeEven(double length);

  std::vector<Triangle> Triangles;

private:
  using Edge = std::array<vtkIdType, 2>;

  static constexpr std::size_t None = static_cast<std::size_t>(-1);

  std::uint64_t KeyOf(const Edge& edge) const
  {
    return (static_cast<std::uint64_t>(edge[0]) << 32) | static_cast<std::uint64_t>(edge[1]);
  }
  /** The triangle that has an edge in this direction. */
  std::size_t TriangleAt(const Edge& edge) const;
  void Add(std::size_t triangle);
  void Remove(std::size_t triangle);
  static vtkIdType Opposite(const Triangle& triangle, const Edge& edge);
  double SquaredLength(const Edge& edge) const;
  /** The edges between two triangles, longest first, that are longer. */
  std::vector<Edge> LongEdges(double length) const;
  void Split(const Edge& edge);
  vtkIdType AddMiddle(const Edge& edge);
  /** Flips edges, and those about them, until each is the better diagonal. */
  void FlipFrom(std::vector<Edge> edges);
  bool TryFlip(const Edge& edge);
  void Smooth();

  vtkPolyData* Surface;
  std::unordered_map<std::uint64_t, std::size_t> AtEdge;
  bool IsManifold = true;
};
}

#endif
