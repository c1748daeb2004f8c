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
 * The components of a surface, between sweeps: their labels, and which of them must go. The same
 * for any executor. SurfaceState::Counts tell what was deleted.
 */
class SurfaceComponents
{
public:
  /**
   * Labels, in SurfaceState::Component, all vertices: components from 0, in the order of their
   * smallest vertices. What is asked for below is asked of these labels.
   */
  void Label(SurfaceState& state, Executor& executor);

  /** How many there were when they were last labelled. */
  int NumberOfComponents() const { return static_cast<int>(this->Roots.size()); }

  /** Add edits to those since the labelling. */
  void Note(const EditCounts& edits) { this->Edits += edits; }
  /** Return the components that are certain to be large after these edits. */
  LargeComponents Large() const
  {
    return LargeComponents{ &this->Sizes, ComponentWatch::SmallSize + 1 }.After(this->Edits);
  }

  /**
   * Deletes the small components that must go (ComponentWatch::DeleteDegenerate).
   * @return whether anything was deleted; labels are fresh then
   */
  bool DeleteDegenerate(SurfaceState& state, Executor& executor);

  /**
   * Labels, and deletes the components that are inside out: a cavity must lie inside the others,
   * any other one outside. Such a one may be born by a cut, of no size and without any
   * intersection, and would grow without limit. They are judged from outside in, as if what is
   * deleted had never been: what lies in one that is inside out need not be.
   * @return whether anything was deleted; labels are fresh then, too
   */
  bool DeleteInsideOut(SurfaceState& state, Executor& executor);

private:
  std::vector<int> Roots; ///< By label: its smallest vertex.
  std::vector<int> Sizes; ///< By label: its vertices at the labelling.
  EditCounts Edits;       ///< Since the labelling.
};
}

#endif
