// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEditor_h
#define volumicSurfaceEditor_h

#include "Core/Common/Box.h"
#include "Core/Surface/NewFaces.h"
#include "Core/Surface/SurfaceState.h"

#include <initializer_list>
#include <vector>

namespace volumic
{
/** How far the faces of an edit may turn. */
enum class EditTolerance
{
  Smooth, ///< As in regular remeshing: 45 degrees.
  Loose   ///< Any new face that is verified and keeps its orientation.
};

/** Result of an edit. A rejected edit changes nothing and converts to false. */
struct Edit
{
  bool IsDone = false;
  int Vertex = -1; ///< New vertex of a split.
  /** Vertices whose ring or position has changed, with duplicates. */
  struct Vertices
  {
    const int* First = nullptr; ///< Valid until the next edit.
    const int* Last = nullptr;
    const int* begin() const { return this->First; }
    const int* end() const { return this->Last; }
  } Changed;

  explicit operator bool() const { return this->IsDone; }
};

/** Data of an editor whose edits run while other threads edit elsewhere, see SurfaceBlocks. */
struct EditContext
{
  Box Region;                  ///< Edits of stars with vertices outside are rejected.
  VertexSlots Slots;           ///< For new vertices. An edit that finds too few is rejected.
  EditCounts Counts;           ///< Counters of the edits of the pass.
  int EulerCharacteristic = 0; ///< Sum of the changes of chi.
};

/**
 * Verified edits of the live surface. An edit is made only if the mesh remains manifold, the
 * constraints on lengths and normals hold, and conservative tests find no intersection with its new
 * faces. Grid, properties, chi and counters are updated. A split needs no test, as it does not
 * change the geometry. Edits are sequential; other threads may edit elsewhere, see EditContext.
 */
class SurfaceEditor
{
public:
  /** @param context null: no other thread edits, and the state has counters and free slots */
  explicit SurfaceEditor(SurfaceState& state, EditContext* context = nullptr)
    : State(state), Context(context)
  {
  }

  /** Split an edge at its midpoint, unless a valence is at its limit. */
  Edit Split(int u, int v);
  /** Collapse an edge to its midpoint, else to one of its ends. */
  Edit Collapse(int u, int v, EditTolerance tolerance);
  /** Collapse an edge to a given position. */
  Edit CollapseTo(int u, int v, const Vector& position, EditTolerance tolerance);
  /**
   * Flip an edge. Smooth: only if the surface is nearly flat and the new edge is legal. Loose: if
   * the new faces are well-shaped, to join two vertices that are too near across a fold.
   */
  Edit Flip(int u, int v, EditTolerance tolerance);
  /** Remove a vertex of valence 3. */
  Edit Remove(int v);
  /** Move a vertex. Smooth: the turn of its faces is limited. */
  Edit Move(int v, const Vector& position, EditTolerance tolerance);
  /** Merge the stars of two vertices. */
  Edit Merge(int u, int v);
  /** Cut the surface along the 3-cycle u, v, w, and separate both sides. */
  Edit Cut(int u, int v, int w);

  /** Return chi of the surface, or within a pass the change of chi by its edits. */
  int EulerCharacteristic() const
  {
    return this->Context ? this->Context->EulerCharacteristic : this->State.EulerCharacteristic;
  }

  /** Return the changed vertices of all edits since TakeChanged(), in order, with duplicates. */
  const std::vector<int>& Changed() const { return this->Log; }
  std::vector<int> TakeChanged();

private:
  Edit CollapseInto(int kept, int removed, const Vector& position, EditTolerance tolerance);
  bool AddFacesAfterCollapse(
    int end, int kept, int removed, const Vector& position, EditTolerance tolerance);
  bool StaysSmooth(int u, int v, const MeshTriangle& first, const MeshTriangle& second) const;
  /** Record a change of v and activate it. */
  void MarkChanged(int v);
  void MarkStarChanged(int v);
  Edit Done(std::size_t firstChange, int vertex = -1) const;
  /** Return whether the stars of these vertices may be edited. */
  bool MayEdit(std::initializer_list<int> vertices) const;
  bool HasSlots(int n) const { return !this->Context || this->Context->Slots.Has(n); }
  VertexSlots* Slots() { return this->Context ? &this->Context->Slots : nullptr; }
  EditCounts& Counts() { return this->Context ? this->Context->Counts : this->State.Counts; }
  void AddToEulerCharacteristic(int change);

  SurfaceState& State;
  EditContext* Context;
  std::vector<MeshTriangle> Faces; ///< New faces of the present edit.
  std::vector<int> Log;
};
}

#endif
