// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentWatch_h
#define volumicComponentWatch_h

#include "Core/Common/Box.h"
#include "Core/Surface/SurfaceEditor.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Components that are certain to have more than ComponentWatch::SmallSize vertices, by the labels
 * of SurfaceComponents.
 */
struct LargeComponents
{
  const std::vector<int>* Sizes = nullptr; ///< Vertices by label at the labelling; null: unknown.
  int LeastSize = 0;                       ///< Labels with fewer are uncertain.

  bool Has(int label) const
  {
    return this->Sizes && static_cast<std::size_t>(label) < this->Sizes->size() &&
      (*this->Sizes)[static_cast<std::size_t>(label)] >= this->LeastSize;
  }
  /**
   * Those that stay certain after some edits: one component may have lost all the vertices that a
   * collapse (one) or a merge (two) removes. A cut may make a small component of any large one.
   */
  LargeComponents After(const EditCounts& edits) const
  {
    return { edits.Cuts > 0 ? nullptr : this->Sizes,
      this->LeastSize + edits.Collapses + 2 * edits.Merges };
  }
};

/**
 * Watches the small components that a visit sees: those that have shrunk to nothing, that lie
 * wholly on the side where they must vanish, or whose signed volume has changed sign are deleted
 * (Documentation/differences.md, Changes of topology).
 */
class ComponentWatch
{
public:
  /** Components up to this many vertices are watched. */
  static constexpr int SmallSize = 400;

  /**
   * The small components that have a vertex in a range, and lie in a box, get labels of their own
   * and are watched; the others are left as they are.
   * @param large components that need no test
   */
  void LabelSmall(
    SurfaceState& state, int begin, int end, const Box& within, const LargeComponents& large = {});

  /**
   * Deletes those of them that must go.
   * @param share of the visit, which keeps the books; null: the state does
   * @return whether anything was deleted.
   */
  bool DeleteDegenerate(SurfaceState& state, EditContext* share = nullptr);

private:
  struct SmallComponent
  {
    int Label = 0;
    std::vector<int> Vertices; ///< When last seen; empty once it has grown or is deleted.
    bool IsPositive = true;    ///< Of the volume, when it was labelled.
  };

  /** Whether a component is a small one; if so, its vertices are in Stack. Marks what it sees. */
  bool IsSmall(SurfaceState& state, int v, const Box& within, const LargeComponents& large);
  /** Finds the vertices that the component has now, in Stack. @return false if it has none. */
  bool FindVertices(SurfaceState& state, const SmallComponent& small);

  std::vector<SmallComponent> Watched;
  std::vector<int> Stack;
  std::vector<int> Pending; ///< Those of Stack with neighbours that have not been seen.
  std::vector<int> AllSeen;
};
}

#endif
