// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceComponents_h
#define volumicSurfaceComponents_h

#include "Core/Common/Executor.h"
#include "Core/Surface/ComponentWatch.h"

#include <vector>

namespace volumic
{
/**
 * Labels the components of a surface between sweeps and deletes degenerate ones. The result does
 * not depend on the executor. SurfaceState::Counts count the deletions.
 */
class SurfaceComponents
{
public:
  /**
   * Label all vertices in SurfaceState::Component: components from 0, in the order of their
   * smallest vertices. The other functions use these labels.
   */
  void Label(SurfaceState& state, Executor& executor);

  /** Return the number of components at the last labelling. */
  int NumberOfComponents() const { return static_cast<int>(this->Roots.size()); }

  /** Add edits made since the labelling. */
  void Note(const EditCounts& edits) { this->Edits += edits; }
  /** Return the components that are certain to be large after these edits. */
  LargeComponents Large() const
  {
    return LargeComponents{ &this->Sizes, ComponentWatch::SmallSize + 1 }.After(this->Edits);
  }

  /**
   * Delete degenerate small components, see ComponentWatch::DeleteDegenerate, then label.
   * @return whether any was deleted
   */
  bool DeleteDegenerate(SurfaceState& state, Executor& executor);

  /**
   * Label, and delete components that are inside out, from outside in: deleted components do not
   * count for those inside. A cavity must lie inside other components, any other component outside.
   * A cut can make a component of zero size that is inside out and would grow without limit. If any
   * is deleted, label again.
   * @return whether any was deleted
   */
  bool DeleteInsideOut(SurfaceState& state, Executor& executor);

private:
  std::vector<int> Roots; ///< By label: smallest vertex.
  std::vector<int> Sizes; ///< By label: number of vertices.
  EditCounts Edits;       ///< Since the labelling.
};
}

#endif
