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
/** How much the faces about an edit may turn. */
enum class EditTolerance
{
  Smooth, ///< As little as in regular remeshing: 45 degrees.
  Loose   ///< Any new face that is verified and does not flip its orientation.
};

/** What an edit has changed. One that was refused has changed nothing, and is false. */
struct Edit
{
  bool IsDone = false;
  int Vertex = -1; ///< The new one of a split.
  /** Vertices whose ring or position is another one; some may be named twice. */
  struct Vertices
  {
    const int* First = nullptr; ///< Valid until the next edit.
    const int* Last = nullptr;
    const int* begin() const { return this->First; }
    const int* end() const { return this->Last; }
  } Changed;

  explicit operator bool() const { return this->IsDone; }
};

/** What an editor has to itself where others are at work elsewhere: see SurfaceBlocks. */
struct EditContext
{
  Box Region;        ///< The vertices whose stars are edited lie in it; others are refused.
  VertexRoom Room;   ///< For new vertices; edits that find too little of it are refused.
  EditCounts Counts; ///< Of the edits of the visit.
  int EulerCharacteristic = 0; ///< What its edits have added to that of the surface.
};

/**
 * Verified edits of the live surface: each checks the mesh (manifold), the constraints (lengths,
 * normals that turn little) and, by conservative tests of the faces that it would make, that none
 * will intersect another; only then it edits and keeps grid, properties, chi and counts in step. A
 * split changes no geometry and needs no test. Sequential, in the order called; others may edit
 * elsewhere at the same time, see EditContext.
 */
class SurfaceEditor
{
public:
  /** @param share null: nobody else edits; counts go to the state, new vertices follow the last
   * one. */
  explicit SurfaceEditor(SurfaceState& state, EditContext* share = nullptr)
    : State(state), Share(share)
  {
  }

  /** Splits an edge at its midpoint; always possible unless a valence is at its limit. */
  Edit Split(int u, int v);
  /** Collapses an edge into its midpoint, or else into one of its ends. */
  Edit Collapse(int u, int v, EditTolerance tolerance);
  /** Collapses an edge into a given position. */
  Edit CollapseTo(int u, int v, const Vector& position, EditTolerance tolerance);
  /**
   * Flips an edge. Smooth: only where the surface is nearly flat and the new edge legal. Loose:
   * wherever the new faces are well-shaped, to join two vertices that are too near to each other
   * across a fold.
   */
  Edit Flip(int u, int v, EditTolerance tolerance);
  /** Removes a vertex of valence 3. */
  Edit Remove(int v);
  /** Moves a vertex; Smooth: the faces about it turn little. */
  Edit Move(int v, const Vector& position, EditTolerance tolerance);
  /** Merges the stars of two vertices. */
  Edit Merge(int u, int v);
  /** Cuts the surface along the 3-cycle u, v, w, and draws both sides apart. */
  Edit Cut(int u, int v, int w);

  /** That of the surface; within a visit only what the visit's edits have added to it. */
  int EulerCharacteristic() const
  {
    return this->Share ? this->Share->EulerCharacteristic : this->State.EulerCharacteristic;
  }

  /** Changed vertices of all edits since TakeChanged(), in order; some may be named often. */
  const std::vector<int>& Changed() const { return this->Log; }
  std::vector<int> TakeChanged();

private:
  Edit CollapseInto(int kept, int removed, const Vector& position, EditTolerance tolerance);
  bool AddFacesAfterCollapse(
    int end, int kept, int removed, const Vector& position, EditTolerance tolerance);
  bool StaysSmooth(int u, int v, const MeshTriangle& first, const MeshTriangle& second) const;
  /** Notes that v has changed; forces act on it again. */
  void Touch(int v);
  void TouchStar(int v);
  Edit Done(std::size_t firstChange, int vertex = -1) const;
  /** Whether the stars of these vertices may be edited. */
  bool MayEdit(std::initializer_list<int> vertices) const;
  bool HasRoom(int n) const { return !this->Share || this->Share->Room.Has(n); }
  VertexRoom* Room() { return this->Share ? &this->Share->Room : nullptr; }
  EditCounts& Counts() { return this->Share ? this->Share->Counts : this->State.Counts; }
  void AddToEulerCharacteristic(int change);

  SurfaceState& State;
  EditContext* Share;
  std::vector<MeshTriangle> Faces; ///< New ones of the edit that is being tried.
  std::vector<int> Log;
};
}

#endif
