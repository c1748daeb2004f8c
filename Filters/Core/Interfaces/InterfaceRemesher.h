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
 * Collapses and flips, which are most of the work, are made by threads in cubes that space is cut
 * into, each with the faces whose middles are in it. Cubes have eight colours, so that between two
 * of a colour there is at least another one: the colours follow one another, and at the end what
 * has come out of its cube, or has images. In a cube faces follow each other in their order. Cubes
 * are wider than edits reach, so that the edits are the same by any number of threads.
 */
class InterfaceRemesher
{
public:
  /**
   * @param shortest, longest between which edges are wanted, times the mesh's sizes; lengths of the
   *                  workspace
   * @param tolerance nearer than that triangles are never
   * @param goOn      asked now and then, on the calling thread; after false no more edits are made
   */
  InterfaceRemesher(InterfaceMesh& mesh, double shortest, double longest, double tolerance,
    Executor& executor, std::function<bool()> goOn);

  /** All edits once. @return how many were made */
  int SplitLongEdges();
  int CollapseShortEdges();
  int FlipEdges();
  int RemoveSlivers();

private:
  InterfaceEdits Edits()
  {
    return InterfaceEdits(this->Mesh, this->Clearance, this->Shortest, this->Longest);
  }
  /** For edits that are tried against what is near; splits change nothing for anybody. */
  void LayGrid();
  /** Whether to look at this face and those after it. */
  bool CanContinue(std::size_t face) { return face % FacesPerProgressCall != 0 || this->GoOn(); }
  /** Longer than this no edge is, nor becomes. */
  float LongestEdge() const;
  /**
   * Visits all faces that are there, those of cubes of a colour by threads.
   * @param visit int(InterfaceEdits&, int face): how many edits it has made
   * @return how many all have
   */
  template <typename Visit>
  int VisitInCubes(const Visit& visit);

  static constexpr std::size_t FacesPerProgressCall = 4096;

  InterfaceMesh& Mesh;
  std::function<bool()> GoOn;
  Executor& Threads;
  InterfaceClearance Clearance;
  bool HasGrid = false; ///< of the mesh as it is
  double Shortest;
  double Longest;
};
}

#endif
