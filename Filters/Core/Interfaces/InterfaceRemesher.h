// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceRemesher_h
#define volumicInterfaceRemesher_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceEdits.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * Passes of edits (InterfaceEdits) over all faces.
 *
 * Collapses and flips run in parallel: space is divided into cubes of eight colours. The colours
 * are processed one after another, the cubes of one colour in parallel, and the faces in a cube in
 * order. Cubes of one colour are not adjacent and wider than the reach of an edit, so that results
 * do not depend on the number of threads. Faces that extend too far beyond their cube, or have
 * periodic images, are processed serially at the end.
 */
class InterfaceRemesher
{
public:
  /**
   * @param shortest, longest range of edge lengths at size 1, in computational space
   * @param tolerance triangles at a smaller distance count as intersecting
   * @param shouldContinue called regularly on the calling thread; returns false to stop editing
   */
  InterfaceRemesher(InterfaceMesh& mesh, double shortest, double longest, double tolerance,
    Executor& executor, std::function<bool()> shouldContinue);

  // Each function makes one pass over all faces and returns the number of edits.
  int SplitLongEdges();
  int CollapseShortEdges();
  int FlipEdges();
  int RemoveSlivers();

private:
  InterfaceEdits Edits()
  {
    return InterfaceEdits(this->Mesh, this->Clearance, this->Shortest, this->Longest);
  }
  /** Build the search structure if it is out of date. Splits do not need it. */
  void UpdateGrid();
  /** Return whether to continue with a face. Calls the callback for some faces only. */
  bool CanContinue(std::size_t n)
  {
    return n % FacesPerProgressCall != 0 || this->ShouldContinue();
  }
  /** Return an upper bound for the length of all edges during a pass. */
  float LongestEdge() const;
  /**
   * Visit all existing faces, in parallel where possible.
   * @param visit int(InterfaceEdits&, int face), returns the number of edits
   * @return total number of edits
   */
  template <typename Visit>
  int VisitInCubes(const Visit& visit);

  static constexpr std::size_t FacesPerProgressCall = 4096;

  InterfaceMesh& Mesh;
  std::function<bool()> ShouldContinue;
  Executor& Threads;
  InterfaceClearance Clearance;
  bool HasGrid = false; ///< Whether Clearance is up to date.
  double Shortest;
  double Longest;
};
}

#endif
