// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceIteration_h
#define volumicSurfaceIteration_h

#include "Core/Common/Box.h"
#include "Core/Common/Executor.h"
#include "Core/Evolution/Dynamics.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Surface/ComponentWatch.h"
#include "Core/Surface/Proximity.h"
#include "Core/Surface/Remesher.h"
#include "Core/Surface/SurfaceState.h"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace volumic
{
/**
 * An iteration: velocities, displacement, splits, verification with roll back, merges and cuts, the
 * other edits, components that must go. It keeps what one iteration tells the next: which pairs of
 * vertices are close, which components are small. Before and after each call the surface is closed,
 * oriented, manifold and free of intersections.
 *
 * Why it stays free of them, by what changes the mesh:
 * - Splits change no place of the surface, but for rounding, less than SizingField::Contact. They
 *   come first and last, so that no edge is longer than eq. (1) allows when anything is looked for.
 * - Collapses, flips, removals, moves, merges and cuts: SurfaceEditor tests each new face exactly
 *   against all that it can reach (NewFacesIntersect), before it edits; none is left out.
 * - Displacements: Proximity tests exactly what is within reach and faces the other way, or is a
 *   star that may be folded. Where two parts of a surface first meet in the course of it, each lies
 *   on its own side of the surface, so a plane touches both and parts them: a normal of one is the
 *   opposite of one of the other, if those of an edge or a corner are all between those of its
 *   faces, which are in its cone. The cones are compared with 30 degrees to spare
 *   (SurfaceState::AreOpposed), for what normals turn from there to the end of the displacement,
 *   half a delta at most. What intersects is rolled back, and more about it, in the last round all:
 *   that is the mesh of before, which needs no test.
 * - Deletions take whole components away.
 * Divisions are tested like displacements. That normals do not turn by more is what was found, not
 * what is enforced: SurfaceEvolution therefore tests all faces against all others, whatever their
 * normals are, at the end of a level, or of a run that was stopped, and in a given start
 * (CountIntersecting).
 */
class SurfaceIteration
{
public:
  /** What drives it: forces; shape and residual; shape alone. */
  enum class Mode
  {
    Evolve,
    Regularise,
    Adapt
  };

  SurfaceIteration(SurfaceState& state, Executor& executor)
    : State(state)
    , Threads(executor)
  {
  }

  /** For a surface whose vertices have other numbers or lie in another grid. */
  void Forget();

  /**
   * From now on it works on the vertices of a list only, all others keep still, as if they were not
   * active; the list may grow between two calls. What happens to components that are not small is
   * left to EndVisit's caller: LabelComponents(), DeleteInsideOut(). The vertices must have a shape
   * that is up to date.
   * @param about what may be looked at
   */
  void BeginVisit(const std::vector<int>& vertices, const Box& about);
  /** On all vertices again. */
  void EndVisit();
  /** The active vertices and those beside them, and what the last iteration has made or changed. */
  const std::vector<int>& WorkingVertices() const { return this->Working; }
  /** Whether cuts or deletions ask for DeleteInsideOut(). */
  bool IsUnchecked() const { return this->Unchecked > 0; }

  /** What it remembers from level to level, of a surface that rests. */
  struct Memory
  {
    int CollapsesSinceLabels = 0;
    int Unchecked = 0;
  };
  Memory Remembered() const { return { this->CollapsesSinceLabels, this->Unchecked }; }
  void Remember(const Memory& memory)
  {
    this->CollapsesSinceLabels = memory.CollapsesSinceLabels;
    this->Unchecked = memory.Unchecked;
  }

  /** Collects the active vertices; their shape is up to date afterwards. */
  void UpdateActive();
  /** Finds close pairs and intersections of the active vertices; edges must be legal. */
  void Examine() { this->Near.Examine(this->State, this->Active, this->Threads); }
  /** The same for intersections alone, in little memory; some may be named more than once. */
  std::vector<Proximity::FacePair> FindIntersections()
  {
    return this->FindIntersections(this->Active);
  }
  std::vector<Proximity::FacePair> FindIntersections(const std::vector<int>& vertices);
  const std::vector<Proximity::FacePair>& Intersections() const
  {
    return this->Near.Intersections();
  }
  /** The vertices that the last iteration, or UpdateActive(), has found active. */
  const std::vector<int>& ActiveVertices() const { return this->Active; }

  /** Splits all edges of the active vertices that are too long. */
  void SplitLongEdges() { this->Active = this->SplitLongEdges(std::move(this->Active)); }
  /** The same for those of a list. @return the list, and the new ones. */
  std::vector<int> SplitLongEdges(std::vector<int> vertices);

  /**
   * Counts and times of phases go to the row; SurfaceState::Counts are those of this iteration.
   * @param number of the iteration, for what is not done in each of them
   * @param goOn   asked when the surface has been displaced and verified: false ends it there
   */
  void Run(HistoryRow& row, Dynamics& dynamics, Remesher& remesher, Mode mode, int number,
    const std::function<bool()>& goOn);

  /** After edits: shape of the vertices, and that their stars must be examined again. */
  void UpdateChanged(std::vector<int> changed);

  // Components, see ComponentWatch.
  void LabelComponents() { this->Watch.Label(this->State, this->Threads); }
  void DeleteDegenerate() { this->Watch.DeleteDegenerate(this->State); }
  void DeleteInsideOut();
  int NumberOfComponents() const { return this->Watch.NumberOfComponents(); }
  /** What others have found (RankComponents). @param areChecked none is inside out */
  void TakeComponents(int number, bool areChecked)
  {
    this->Watch.TakeNumber(number);
    this->Unchecked = areChecked ? 0 : this->Unchecked;
  }

private:
  void CollectActive();
  void ClearMarks();
  void Label();
  void CollectWorking();
  void AddUnmoved(int v);
  bool IsSuspect(int v) const;
  void CollectSuspects();
  void RollBack();
  void RollBackVertex(int v);
  void SplitBeforeVerification(Remesher& remesher);
  void RestoreConstraints(Remesher& remesher);
  void WatchComponents(int number);

  SurfaceState& State;
  Executor& Threads;
  Proximity Near;    ///< Of all; keeps the pairs.
  Proximity Recheck; ///< Of what has been rolled back.
  ComponentWatch Watch;
  const std::vector<int>* Visited = nullptr; ///< See BeginVisit; null: all vertices.
  Box About; ///< See BeginVisit.
  std::vector<int> Active;
  std::vector<int> Working;            ///< See CollectWorking.
  LargeVector<std::uint8_t> IsWorking; ///< Whether that has it.
  std::vector<int> Suspects;           ///< See CollectSuspects.
  int CollapsesSinceLabels = 0;
  int Unchecked = 0; ///< Cuts and deletions since components were last judged from outside in.
};
}

#endif
