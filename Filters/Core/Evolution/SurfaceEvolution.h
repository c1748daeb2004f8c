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
  LimitCycle, ///< It goes to and fro without getting anywhere, see CycleCriterion.
  IterationLimit,
  Cancelled,
  Vanished ///< No component is left.
};

/** Return the text in the output's field data: "converged", "limit cycle", "vanished", ... */
const char* Describe(StopReason reason);

/** What a surface begins with on the coarsest level; lengths are those of the workspace. */
struct SurfaceStart
{
  enum class Kind
  {
    Enclosing, ///< A rounded box about the image, see EnclosingSurface.
    /**
     * What encloses the parts of the object of at least MinimumPartSize voxels, as where all of it
     * has been lost (FindMissedParts): near to them, where the way from a box takes hundreds of
     * iterations if the level is not a coarse one. Where there is none, Enclosing.
     */
    EnclosingParts,
    /** Icosahedra of SeedRadius about Seeds or, where these are none, about ChooseSeeds' own. */
    Seeds,
    /**
     * Surface, which must be closed, remeshed to the constraints of delta: no edge is longer than
     * 2.5 delta, none but a few in places narrower than that shorter than delta, and nothing
     * intersects, which is tested.
     */
    Surface,
    IsoSurface ///< The same for all of the object, however small its parts are.
  };
  Kind From = Kind::Enclosing;
  std::vector<Point> Seeds;
  IndexedSurface Surface;
};

/** A level that a surface is to come to rest on. */
struct LevelTask
{
  SurfaceOptions Options;
  LevelImage Image;
  int Level = 0;
  const SurfaceStart* Start = nullptr; ///< Null: the surface at rest of a coarser level is divided.
  /**
   * Before the final regularisation delta is changed by small steps, as far as eq. (7) allows,
   * until the mean of the edges is this long; 0: as it comes. Within 3 % where eq. (7) does not end
   * it.
   */
  double MeanEdgeLength = 0.;
  /**
   * Of the last level: it is divided only where what is seen there asks for it, and with a
   * tolerance edges become longer where it rests, as far as it stays within that of the
   * isopotential.
   */
  volumic::Grading Grading;
  /**
   * Called when the surface has come to the level, and after each sweep. take() returns the
   * surface, or an empty one if a test of all faces finds an intersection.
   */
  std::function<void(int iteration, const std::function<SurfaceResult()>& take)> Observe;
};

/** Lost parts that were found when a surface came to a level, and how many of them it encloses. */
struct MissedParts
{
  int Found = 0; ///< Parts of the object outside the surface; told also where recovery is off.
  int Enclosed = 0;
  int FoundCavities = 0; ///< Parts of the background inside it; looked for only on request.
  int EnclosedCavities = 0;
  int Missing = 0;             ///< Of all found, those that the surface misses at the end.
  double MissingBoundary = 0.; ///< And the share of the whole boundary; see MissedBoundary.
};

/**
 * What the tests of all faces have found at the end: vertices whose faces intersected others,
 * 0 but for an error of Volumic, and how many are left after the surface has got another mesh.
 */
struct Verdict
{
  int Found = 0;
  int Left = 0;
  /** What is told where something was found. */
  std::string Describe(int level) const;
};

/** How a surface has come through a level. */
struct LevelOutcome
{
  bool HasReachedEnd = false; ///< Else it was stopped before, and is as it was.
  StopReason Reason = StopReason::Cancelled;
  SurfaceResult Surface;
  int Iterations = 0;
  MissedParts Missed;
  Verdict Verified;
};

/** @throws std::invalid_argument for options outside their range. */
void CheckOptions(const SurfaceOptions& options);

/**
 * The deformable surface: a closed triangulated mesh that follows an isopotential from coarse to
 * fine (the paper's sections 3 to 5, and Documentation/differences.md). This takes it to a level,
 * by a start or by as many sqrt 3 divisions as bring delta nearest to the level's, and evolves it
 * there until it rests, cycles, has had its iterations, nothing is left or the monitor has said
 * stop, after which this is not asked again.
 *
 * Whenever it is taken, and at the end, it is closed, oriented, manifold and verified to be free of
 * self-intersections; at the end no component is inside out. Bit-identical for any executor.
 *
 * @param rest what the level before has left; afterwards what this one leaves, which must have come
 *             to rest to be divided
 * @throws std::invalid_argument for a start that cannot be used, or too thin for such triangles
 */
LevelOutcome EvolveOnLevel(
  const LevelTask& task, ConvergedSurface& rest, Executor& executor, Monitor& monitor);
}

#endif
