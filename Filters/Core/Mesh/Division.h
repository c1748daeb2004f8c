// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDivision_h
#define volumicDivision_h

#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Numbers for the ends of the edges of a mesh, which must stay as it is: vertex by vertex. */
class EdgeSlots
{
public:
  explicit EdgeSlots(const SurfaceMesh& mesh, Executor& executor = OnThisThread());

  /** Of the edge from v to its neighbour i, and of the face between that neighbour and the next. */
  std::size_t At(int v, int i) const
  {
    return this->First[static_cast<std::size_t>(v)] + static_cast<std::size_t>(i);
  }
  std::size_t Count() const { return this->First.back(); }

private:
  LargeVector<std::size_t> First; ///< Six for each vertex are more than an int counts.
};

/** Edges of a mesh that a division is to leave where they are. The mesh must stay as it is. */
class KeptEdges
{
public:
  explicit KeptEdges(const SurfaceMesh& mesh);

  void Keep(int u, int v);
  void KeepAllAt(int v);
  void KeepAll() { this->Flags.assign(this->Flags.size(), 1); }
  /** Keeps more of them, all those of some vertices, so that no ring overflows by the division. */
  void MakeRoom();

  /** Of the edge from v to its neighbour i. */
  bool Has(int v, int i) const { return this->Flags[this->Slots.At(v, i)] != 0; }
  bool HasAfter(int v, int i) const
  {
    return this->Has(v, i + 1 < this->Mesh.Rings[v].Count ? i + 1 : 0);
  }

private:
  const SurfaceMesh& Mesh;
  EdgeSlots Slots;
  LargeVector<std::uint8_t> Flags; ///< Both ends of an edge have one.
};

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
 * @return the old faces: the centre of face i is the vertex with i plus the number of old ones.
 * The middles of edges come last. `mesh` must have no free places, `kept` be of a copy of it.
 */
LargeVector<Triangle> Divide(SurfaceMesh& mesh, const KeptEdges* kept = nullptr,
  Executor& executor = OnThisThread());

/** What Divide(mesh) has made the mesh from; that had so many vertices. */
SurfaceMesh Undivided(
  const SurfaceMesh& mesh, int numberOfVertices, Executor& executor = OnThisThread());
}

#endif
