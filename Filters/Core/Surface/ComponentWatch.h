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
/** Components that certainly exceed ComponentWatch::SmallSize, by SurfaceComponents' labels. */
struct LargeComponents
{
  const std::vector<int>* Sizes = nullptr; ///< Vertices by label at the labelling; null: unknown.
  int LeastSize = 0;                       ///< Smaller labels are uncertain.

  bool Has(int label) const
  {
    return this->Sizes && static_cast<std::size_t>(label) < this->Sizes->size() &&
      (*this->Sizes)[static_cast<std::size_t>(label)] >= this->LeastSize;
  }
  /**
   * Return the components that are still large after some edits. In the worst case all vertices
   * removed by collapses (one each) and merges (two each) belonged to the same component. A cut can
   * split a small component from any large one.
   */
  LargeComponents After(const EditCounts& edits) const
  {
    return { edits.Cuts > 0 ? nullptr : this->Sizes,
      this->LeastSize + edits.Collapses + 2 * edits.Merges };
  }
};

/**
 * Deletes small components that a block pass finds degenerate: components that have shrunk to
 * nothing, lie wholly on the side where they must vanish, or whose signed volume has changed sign.
 * See Documentation/differences.md, Changes of topology.
 */
class ComponentWatch
{
public:
  /** Maximum number of vertices of a small component. */
  static constexpr int SmallSize = 400;

  /**
   * Give labels to the small components that lie in a box and have a vertex in the range [begin,
   * end), and watch them. Others keep their labels.
   * @param large components that need no test
   */
  void LabelSmall(
    SurfaceState& state, int begin, int end, const Box& within, const LargeComponents& large = {});

  /**
   * Delete the degenerate components among those watched.
   * @param context of the block pass, which counts the deletions; null: the state counts them
   * @return whether any was deleted
   */
  bool DeleteDegenerate(SurfaceState& state, EditContext* context = nullptr);

private:
  struct SmallComponent
  {
    int Label = 0;
    std::vector<int> Vertices; ///< When last found; empty once it has grown or is deleted.
    bool IsPositive = true;    ///< Sign of the volume when it was labelled.
  };

  /** Return whether the component of v is small, with its vertices in Stack. Mark tested ones. */
  bool IsSmall(SurfaceState& state, int v, const Box& within, const LargeComponents& large);
  /** Find the present vertices of the component, in Stack. Return false if there are none. */
  bool FindVertices(SurfaceState& state, const SmallComponent& small);

  std::vector<SmallComponent> Watched;
  std::vector<int> Stack;
  std::vector<int> Pending; ///< Part of Stack with neighbours that are not tested yet.
  std::vector<int> AllSeen;
};
}

#endif
