// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRemesher_h
#define volumicRemesher_h

#include "Core/Image/Field.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Surface/EditCells.h"
#include "Core/Surface/Proximity.h"

#include <vector>

namespace volumic
{
/**
 * Restores the constraints of eq. (1) after a displacement and decides on merges and cuts, the
 * paper's changes of topology, with the rules of Documentation/differences.md (Constraints,
 * Changes of topology). Each operation is a pass of EditCells over the vertices that it concerns:
 * on all threads, in an order that does not depend on them.
 */
class Remesher
{
public:
  /** `field` null: no image evidence is asked for. */
  Remesher(SurfaceState& state, const Field* field, bool topologyChanges, Executor& threads)
    : State(state)
    , Threads(threads)
    , Cells(state, threads)
    , TheField(field)
    , TopologyChanges(topologyChanges)
  {
  }

  /**
   * Splits all edges at these vertices that are longer than eq. (1) allows, where a ring is full
   * after others that make room. New vertices are appended to the list.
   * Changes no geometry, so it comes before verification, which relies on it.
   */
  void Split(std::vector<int>& vertices);

  /** Merges stars that have come too near and that the image wants joined; nearest first. */
  void Merge(const std::vector<Proximity::ClosePair>& pairs);

  /** Collapses edges shorter than eq. (1) allows, cutting along 3-cycles where they are blocked. */
  void Collapse(const std::vector<int>& vertices);

  /** Flips edges that are not locally Delaunay where the surface is nearly flat. */
  void Flip(const std::vector<int>& vertices);

  /** Vertices rolled back again and again: collapses and smooths, verified. */
  void Unstick(const std::vector<int>& vertices);

  /** Changed vertices of all edits since the last call, in order; some may be named often. */
  std::vector<int> TakeChanged() { return this->Cells.TakeChanged(); }
  const std::vector<int>& Changed() const { return this->Cells.Changed(); }

private:
  // Called side by side: they must change nothing but the surface, by the editor.
  bool SplitEdge(SurfaceEditor& editor, int u, int v, std::vector<int>& added, int depth) const;
  /** Whether what lies opposite to an edge is so near to its middle that a split would. */
  bool MakesNeedles(int u, int v, const EdgeFlip& across) const;
  void SplitAt(SurfaceEditor& editor, int v, std::vector<int>& added) const;
  bool IsMergeWanted(int u, int v) const;
  bool FlipBetween(SurfaceEditor& editor, int u, int v) const;
  void MergeOrFlip(SurfaceEditor& editor, int u, int v, std::vector<int>& strip) const;
  void CollapseAt(SurfaceEditor& editor, int v) const;
  void FlipAt(SurfaceEditor& editor, int v) const;
  void UnstickAt(SurfaceEditor& editor, int v) const;

  /** The vertices that are alive and have the flag. */
  std::vector<int> Flagged(const std::vector<int>& vertices, RemeshFlag flag) const;
  float LongestEdgeAt(const std::vector<int>& vertices) const;

  SurfaceState& State;
  Executor& Threads;
  EditCells Cells;
  const Field* TheField;
  bool TopologyChanges;
};
}

#endif
