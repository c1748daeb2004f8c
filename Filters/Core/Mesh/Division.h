// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDivision_h
#define volumicDivision_h

#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/** Edges that a division does not flip. The mesh must not change during its lifetime. */
class KeptEdges
{
public:
  explicit KeptEdges(const SurfaceMesh& mesh) : Mesh(mesh)
  {
    MakeZeroed(this->Flags, mesh.Rings.size());
  }

  void Keep(int u, int v);
  void KeepAllAt(int v);
  void KeepAll();
  /**
   * Return the vertices whose rings would exceed Ring::Capacity in the division. The caller keeps
   * all edges at these vertices and repeats until none is returned.
   */
  std::vector<int> FindOverfull() const;

  /** Return whether the edge from v to its neighbour i is kept. */
  bool Has(int v, int i) const { return (this->Flags[v] >> i & 1u) != 0; }
  bool HasAfter(int v, int i) const
  {
    return this->Has(v, i + 1 < this->Mesh.Rings[v].Count ? i + 1 : 0);
  }
  /** Return the number of kept edges of v whose other end has a greater index. */
  int CountFrom(int v) const;

private:
  void KeepAt(int v, int neighbour);

  using RingFlags = std::uint16_t; ///< One bit per neighbour.
  static_assert(Ring::Capacity <= 16, "each has a bit");
  const SurfaceMesh& Mesh;
  LargeVector<RingFlags> Flags; ///< Set at both ends of an edge.
};

/** Numbers of the new vertices, in the order of the smallest old vertex of their face or edge. */
struct DivisionNumbers
{
  /** By vertex: faces before those whose smallest vertex it is. */
  LargeVector<int> FirstFace;
  int Faces = 0; ///< Total number.
  /** By vertex: kept edges before those whose smaller end it is. Empty: none is kept. */
  LargeVector<int> FirstMidpoint;
  int Midpoints = 0;
};

DivisionNumbers NumberForDivision(
  const SurfaceMesh& mesh, const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());

/**
 * Divide all triangles with factor sqrt 3 (the paper's section 5.1). A new vertex at the centroid
 * of each face is joined to its corners, then every edge between two old vertices is flipped. The
 * number of vertices triples, edges get shorter by sqrt 3. Old vertices keep index, position and
 * valence, new ones have valence 6, chi is unchanged. See also L. Kobbelt, "sqrt(3)-subdivision",
 * SIGGRAPH 2000, which also smooths the old vertices.
 *
 * The flips cut off convex edges and fill concave ones, which can make the surface intersect
 * itself. Therefore an edge of `kept` is not flipped but gets a vertex at its midpoint, and a
 * corner between two such edges is cut off within its face. The surface is unchanged along kept
 * edges.
 *
 * The centroid of face i has the index i plus the number of old vertices. The midpoints come last.
 * `mesh` must have no free slots, and `kept` must refer to it.
 */
[[nodiscard]] SurfaceMesh Divide(const SurfaceMesh& mesh, const DivisionNumbers& numbers,
  const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());

/** Number the new vertices, then divide. */
[[nodiscard]] SurfaceMesh Divide(
  const SurfaceMesh& mesh, const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());
}

#endif
