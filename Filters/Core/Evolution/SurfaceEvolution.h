// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEvolution_h
#define volumicSurfaceEvolution_h

#include "Core/Common/Executor.h"
#include "Core/Common/Grading.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Monitor.h"
#include "Core/Evolution/ConvergedSurface.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Evolution/SurfaceResult.h"
#include "Core/Image/LevelImage.h"

#include <functional>
#include <string>
#include <vector>

namespace volumic
{
enum class StopReason
{
  Converged,
  LimitCycle, ///< see CycleCriterion
  IterationLimit,
  Cancelled,
  Vanished ///< no component is left
};

/** Return the text in the output's field data: "converged", "limit cycle", "vanished", ... */
const char* Describe(StopReason reason);

/** Initial surface at the coarsest level. Lengths are in the computational space. */
struct SurfaceStart
{
  enum class Kind
  {
    Enclosing, ///< rounded box around the image, see EnclosingSurface()
    /**
     * Recovery surfaces around all parts of at least MinimumPartSize voxels (FindMissedParts). They
     * save the hundreds of iterations that a box needs at a fine level. Without parts: Enclosing.
     */
    EnclosingParts,
    /** Icosahedra of SeedRadius around Seeds, or around the seeds of ChooseSeeds(). */
    Seeds,
    /**
     * Surface, which must be closed, remeshed: no edge is longer than 2.5 delta, few edges in thin
     * regions are shorter than delta, and there are no intersections.
     */
    Surface,
    IsoSurface ///< recovery surfaces around all parts of any size
  };
  Kind From = Kind::Enclosing;
  std::vector<Point> Seeds;
  IndexedSurface Surface;
};

/** Options of the evolution on a level. */
struct LevelTask
{
  SurfaceOptions Options;
  LevelImage Image;
  int Level = 0;
  const SurfaceStart* Start = nullptr; ///< null: divide the surface of the coarser level
  /**
   * Requested mean edge length, met within 3 % by small changes of delta within eq. (7), before the
   * final regularisation; 0: none.
   */
  double MeanEdgeLength = 0.;
  /**
   * Graded edge lengths of the last level: subdivide only where required, and with a tolerance,
   * lengthen edges of the converged surface within the tolerance.
   */
  volumic::Grading Grading;
  /**
   * Called when the surface has reached the level, and after each sweep. take() returns the
   * surface, or an empty one if a test of all faces finds an intersection.
   */
  std::function<void(int iteration, const std::function<SurfaceResult()>& take)> Observe;
};

/** Parts missed by the coarser level, and recovered ones. */
struct MissedParts
{
  int Found = 0; ///< parts of the object outside the surface, also without recovery
  int Enclosed = 0;
  int FoundCavities = 0; ///< parts of the background inside, on request only
  int EnclosedCavities = 0;
  int Missing = 0;             ///< parts that the final surface misses
  double MissingBoundary = 0.; ///< fraction of the boundary, see MissedBoundary
};

/**
 * Result of the final intersection test: number of vertices with intersecting faces (a defect of
 * Volumic if not 0), and number left after remeshing.
 */
struct Verdict
{
  int Found = 0;
  int Left = 0;
  /** Return the warning, if any. */
  std::string Describe(int level) const;
};

/** Result of EvolveOnLevel(). */
struct LevelOutcome
{
  bool HasReachedLevel = false; ///< false: cancelled before any change
  StopReason Reason = StopReason::Cancelled;
  SurfaceResult Surface;
  int Iterations = 0;
  MissedParts Missed;
  Verdict Verified;
};

/** Throw std::invalid_argument if an option is out of range. */
void CheckOptions(const SurfaceOptions& options);

/**
 * Evolve a deformable surface on a level (sections 3 to 5 of the paper,
 * Documentation/differences.md). The surface starts from Start, or from the coarser level by the
 * sqrt 3 divisions that bring delta nearest to that of the level. It evolves until one of the stop
 * reasons applies.
 *
 * Each result is closed, oriented, manifold and tested to be free of self-intersections. No
 * component of the final surface is inside out. Results are bit-identical for any executor.
 *
 * @param converged in: the converged surface of the coarser level; out: that of this level, if it
 * has converged
 * @throws std::invalid_argument if Start is invalid, or thinner than the triangles
 */
LevelOutcome EvolveOnLevel(
  const LevelTask& task, ConvergedSurface& converged, Executor& executor, Monitor& monitor);
}

#endif
