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
 * Restores the constraints of eq. (1) after a displacement and decides on merges and cuts, the
 * paper's changes of topology, with the rules of Documentation/differences.md (Constraints,
 * Changes of topology). Each operation is a pass over the vertices that it concerns, in their
 * order.
 */
class Remesher
{
public:
  /**
   * @param field null: no image evidence is asked for
   * @param share of the visit; null: nobody else edits
   */
  Remesher(
    SurfaceState& state, const Field* field, bool topologyChanges, EditContext* share = nullptr)
    : State(state), Editor(state, share), TheField(field), TopologyChanges(topologyChanges)
  {
  }

  /**
   * Splits all edges at these vertices that are longer than eq. (1) allows. Where a ring is full,
   * other edges are split first to make room. New vertices are appended to the list.
   * Changes no geometry, so it comes before verification, which relies on it.
   */
  void Split(std::vector<int>& vertices);

  /** Merges stars that have come too near and that the image wants joined; nearest first. */
  void Merge(const std::vector<Proximity::ClosePair>& pairs);

  /** Collapses edges shorter than eq. (1) allows, cutting along 3-cycles where they are blocked. */
  void Collapse(const std::vector<int>& vertices);

  /** Flips edges that are not locally Delaunay where the surface is nearly flat. */
  void Flip(const std::vector<int>& vertices);

  /** Collapses or smooths, verified, about vertices that are rolled back again and again. */
  void Unstick(const std::vector<int>& vertices);

  /** Changed vertices of all edits since the last call, in order; some may be named often. */
  std::vector<int> TakeChanged() { return this->Editor.TakeChanged(); }
  const std::vector<int>& Changed() const { return this->Editor.Changed(); }

private:
  bool SplitEdge(int u, int v, std::vector<int>& added, int depth);
  /** Whether what lies opposite to an edge is so near to its middle that a split would. */
  bool MakesNeedles(int u, int v, const EdgeFlip& across) const;
  void SplitAt(int v, std::vector<int>& added);
  bool AreApproaching(int u, int v) const;
  bool FlipBetween(int u, int v);
  void MergeOrFlip(int u, int v, std::vector<int>& strip);
  void CollapseAt(int v);
  void FlipAt(int v);
  void UnstickAt(int v);

  /** Fills Items with the vertices that are alive and have the flag. */
  void Find(const std::vector<int>& vertices, RemeshFlag flag);

  SurfaceState& State;
  SurfaceEditor Editor;
  const Field* TheField;
  bool TopologyChanges;
  std::vector<int> Items; ///< The vertices of a pass.
};
}

#endif
