// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRemesher_h
#define volumicRemesher_h

#include "Core/Image/Field.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Surface/Proximity.h"
#include "Core/Surface/SurfaceEditor.h"

#include <vector>

namespace volumic
{
/**
 * Restores the constraints of eq. (1) after a displacement and decides on merges and cuts. See
 * Documentation/differences.md, Constraints and Changes of topology. Each operation is a pass over
 * the vertices concerned, in order.
 */
class Remesher
{
public:
  /**
   * @param field image evidence for merges; null: none is required
   * @param context of the block pass; null: no other thread edits
   */
  Remesher(
    SurfaceState& state, const Field* field, bool topologyChanges, EditContext* context = nullptr)
    : State(state), Editor(state, context), TheField(field), TopologyChanges(topologyChanges)
  {
  }

  /**
   * Split all edges at these vertices that are longer than eq. (1) allows. If a ring is full, other
   * edges are split first. New vertices are appended to the list. The geometry is unchanged. Call
   * it before the intersection tests, which rely on its result.
   */
  void Split(std::vector<int>& vertices);

  /** Merge stars that are too near and that the image requires to be joined, nearest first. */
  void Merge(const std::vector<Proximity::ClosePair>& pairs);

  /** Collapse edges shorter than eq. (1) allows. Cut along 3-cycles that block a collapse. */
  void Collapse(const std::vector<int>& vertices);

  /** Flip edges that are not locally Delaunay where the surface is nearly flat. */
  void Flip(const std::vector<int>& vertices);

  /** Collapse an edge at, or smooth, vertices that are rolled back repeatedly. */
  void Unstick(const std::vector<int>& vertices);

  /** Return the changed vertices of all edits since the last call, in order, with duplicates. */
  std::vector<int> TakeChanged() { return this->Editor.TakeChanged(); }
  const std::vector<int>& Changed() const { return this->Editor.Changed(); }

private:
  bool SplitEdge(int u, int v, std::vector<int>& added, int depth);
  /** Return whether a split makes needles: an opposite vertex is near, or the edge is short. */
  bool MakesNeedles(int u, int v, const EdgeFlip& across) const;
  void SplitAt(int v, std::vector<int>& added);
  bool AreApproaching(int u, int v) const;
  bool FlipBetween(int u, int v);
  void MergeOrFlip(int u, int v, std::vector<int>& strip);
  void CollapseAt(int v);
  void FlipAt(int v);
  void UnstickAt(int v);

  /** Collect alive vertices with a flag in Items. */
  void Find(const std::vector<int>& vertices, RemeshFlag flag);

  SurfaceState& State;
  SurfaceEditor Editor;
  const Field* TheField;
  bool TopologyChanges;
  std::vector<int> Items; ///< Vertices of a pass.
};
}

#endif
