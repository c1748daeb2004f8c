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
/** Edges of a mesh that a division is to leave where they are. The mesh must stay as it is. */
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
   * Vertices whose rings would overflow by the division. All edges at these are to be kept, then at
   * those that overflow then, and so on.
   */
  std::vector<int> FindOverfull() const;

  /** Of the edge from v to its neighbour i. */
  bool Has(int v, int i) const { return (this->Flags[v] >> i & 1u) != 0; }
  bool HasAfter(int v, int i) const
  {
    return this->Has(v, i + 1 < this->Mesh.Rings[v].Count ? i + 1 : 0);
  }
  /** How many of those of v whose other end has a greater index. */
  int CountFrom(int v) const;

private:
  void KeepAt(int v, int neighbour);

  using RingFlags = std::uint16_t; ///< A bit for each neighbour.
  static_assert(Ring::Capacity <= 16, "each has a bit");
  const SurfaceMesh& Mesh;
  LargeVector<RingFlags> Flags; ///< Both ends of an edge have one.
};

/** What new vertices of a division come of is numbered in the order of the smallest old one. */
struct DivisionNumbers
{
  /** By vertex: how many faces come before those that it is the smallest of. */
  LargeVector<int> FirstFace;
  int Faces = 0; ///< All of them.
  /** By vertex: how many kept edges before those that it is the smaller end of. Empty: none. */
  LargeVector<int> FirstMiddle;
  int Middles = 0;
};

DivisionNumbers NumberForDivision(
  const SurfaceMesh& mesh, const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());

/**
 * Global division with factor sqrt 3 (the paper's section 5.1; L. Kobbelt has published the same
 * refinement as "sqrt(3)-subdivision", SIGGRAPH 2000, with a rule that smooths the old vertices,
 * which here stay where they are): a new vertex at the centre of every face, joined to its
 * corners; then every edge between two old vertices is flipped. Vertices become three times as
 * many, edges sqrt 3 times shorter. Old vertices keep index and valence, new ones have 6; chi
 * stays.
 *
 * The flips cut convex edges off and fill concave ones, which may make the surface intersect
 * itself. An edge of `kept` is not flipped but gets a vertex in its middle; a corner between two of
 * these is cut off along the face that it is a part of. So the surface stays where it was along
 * them, and is the old one if all are kept.
 *
 * The centre of face i is the vertex with i plus the number of old ones. The middles of edges come
 * last. `mesh` must have no empty places, `kept` be of it.
 */
[[nodiscard]] SurfaceMesh Divide(const SurfaceMesh& mesh, const DivisionNumbers& numbers,
  const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());

/** The same, which numbers it. */
[[nodiscard]] SurfaceMesh Divide(
  const SurfaceMesh& mesh, const KeptEdges* kept = nullptr, Executor& executor = OnThisThread());
}

#endif
