// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEvolution_h
#define volumicSurfaceEvolution_h

#include "Core/Common/CheckedFile.h"
#include "Core/Common/Executor.h"
#include "Core/Common/Grading.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Monitor.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/LevelImage.h"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
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

/** As in the output's field data: converged, limit cycle, iteration limit, cancelled, vanished. */
const char* Describe(StopReason reason);

/** Parts of an iteration, and of what lies between two, in the order of HistoryRow::PhaseSeconds. */
enum class Phase
{
  Forces,
  Contact,
  Proximity,
  Verification,
  Remeshing,
  Topology,
  Division, ///< Division, start.
  Recovery, ///< Of lost parts.
  Regularisation, ///< The final one.
  Count
};

/**
 * One iteration, and what comes before the first and after the last one of a level. Lengths are
 * those of the workspace.
 *
 * What happens to the Euler characteristic is explained row by row:
 *
 *   IterationEulerCharacteristic = EulerCharacteristic of the row before, 0 in the first,
 *     + AddedEulerCharacteristic + 2 (Cuts - Merges - Deletions + DeletedGenus)
 *   EulerCharacteristic = IterationEulerCharacteristic
 *     + 2 (RegularisationCuts - RegularisationDeletions)
 *
 * (and, if a regularisation should ever delete a component with handles, twice their number).
 * SecondsBefore, Seconds and SecondsAfter of all rows follow each other without a gap. Iterations are
 * made in sweeps of five over the blocks (SurfaceBlocks): a row adds up what all blocks did in the
 * same one; MeanEdgeLength and Components are those at the end of the sweep, TimeStep the longest.
 */
struct HistoryRow
{
  int Iteration = 0; ///< Counted over all levels, from 1.
  int Level = 0;
  int Vertices = 0;
  double KineticEnergy = 0.; ///< Mean over vertices of half the squared speed along the normal.
  double MeanEdgeLength = 0.;
  double Seconds = 0.;  ///< Of those of its sweep, what was spent in this iteration.
  double TimeStep = 0.;
  int ActiveVertices = 0;
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  /** Like Vertices, MeanEdgeLength, Components: in the last row of a level as regularised. */
  int EulerCharacteristic = 0;
  int Components = 0;
  int Recovered = 0; ///< Lost parts and cavities enclosed again before the first of a level.
  int Deletions = 0;    ///< Components deleted.
  int DeletedGenus = 0; ///< Sum of their genera.
  /** Of what came new before this iteration: the start, what encloses lost parts. */
  int AddedEulerCharacteristic = 0;
  /** What the iteration itself has left: the same but for the last one of a level. */
  int IterationVertices = 0;
  double IterationMeanEdgeLength = 0.;
  int IterationEulerCharacteristic = 0;
  int IterationComponents = 0;
  int RegularisationCuts = 0;
  int RegularisationDeletions = 0;
  double SecondsBefore = 0.; ///< Between the row before, or the start of the clock, and this one.
  double SecondsAfter = 0.;  ///< After the last iteration of a level, until EndLevel().
  std::array<double, static_cast<int>(Phase::Count)> PhaseSeconds{};
};

/** The surface as handed out: compact, workspace coordinates. */
struct SurfaceResult : IndexedSurface
{
  LargeVector<std::array<float, 3>> Normals;  ///< Unit, outward, per point.
  LargeVector<float> Residual;                ///< Field minus iso-value, per point.
  LargeVector<unsigned char> Motionless;      ///< 1 where frozen, per point.
  LargeVector<unsigned char> Held;            ///< Per point, see RemainingContacts.
  LargeVector<std::array<int, 2>> Contacts;   ///< Pairs of points, see RemainingContacts.
  double Delta = 0.;                          ///< delta_h, workspace.
  LargeVector<float> Size;      ///< Of a graded surface delta per point, workspace; else empty.
  LargeVector<float> Thickness; ///< With thin parts, per point, workspace; else empty.
  std::optional<Fit> FitToTolerance; ///< With a tolerance, from the time on when it rested.
};

/**
 * The deformable surface: a closed triangulated mesh that follows an isopotential from coarse to
 * fine (the paper's sections 3 to 5, and Documentation/differences.md). Usage:
 *
 *   SurfaceEvolution evolution(options, executor, monitor);
 *   evolution.StartEnclosing(coarsest, h);      // or StartSeeds, StartSurface
 *   StopReason reason = evolution.Run();        // until it rests
 *   SurfaceResult surface = evolution.Result();
 *   evolution.Divide(finer, h - 1);             // sqrt 3 division, then Run() again
 *
 * Between the calls the surface is always closed, oriented, manifold and free of
 * self-intersections, see Verified(). Results are bit-identical for any executor.
 * Executor, monitor and the values of the current level must outlive the object.
 */
class SurfaceEvolution
{
public:
  /** @throws std::invalid_argument for options outside their range. */
  SurfaceEvolution(const SurfaceOptions& options, Executor& executor, Monitor& monitor);
  ~SurfaceEvolution();
  SurfaceEvolution(const SurfaceEvolution&) = delete;
  SurfaceEvolution& operator=(const SurfaceEvolution&) = delete;

  /** Start from a rounded box about the image, see EnclosingSurface. */
  void StartEnclosing(const LevelImage& image, int level);

  /**
   * Start as where all of the object has been lost: from what encloses its parts of at least
   * MinimumPartSize voxels, see FindLostParts and Lost(). It is near to them, where the way from a
   * box takes hundreds of iterations if the level is not a coarse one. Where there is no such part,
   * or RecoverLostParts is off: as StartEnclosing.
   */
  void StartEnclosingParts(const LevelImage& image, int level);

  /**
   * Start from icosahedra of SeedRadius about the centres (workspace); where there are none, on a
   * grid of points inside the object. Centres outside the object or too near to each other are
   * left out. @return the number of seeds set.
   * @throws std::invalid_argument when none is left or a centre lies outside the image.
   */
  int StartSeeds(const LevelImage& image, int level, const std::vector<Point>& centres);

  /**
   * Start from a closed surface (workspace), remeshed to the constraints of delta: afterwards no
   * edge is longer than 2.5 delta, none but a few in places narrower than that shorter than delta,
   * and nothing intersects, which is tested. The monitor is asked meanwhile; once it has said stop
   * Run() does nothing.
   * @throws std::invalid_argument as CheckInitialSurface and CheckOverlapsImage, or where the
   * surface is too thin for triangles of this size.
   */
  void StartSurface(const LevelImage& image, int level, const IndexedSurface& surface);

  /** The same from the iso-surface of the image, closed, as VTK's algorithms make it. */
  void StartIsoSurface(const LevelImage& image, int level, const IndexedSurface& surface);

  /**
   * Evolve on the current level until rest, cycle, limit, cancel or nothing is left; then snap. No
   * component that is inside out is left behind, also where cancelled. Once the monitor has said
   * stop, wherever it was asked, the reason is Cancelled.
   */
  StopReason Run();

  /**
   * After Run(), where voxels of the level have been changed in a few places, and not by much: what
   * is off the isopotential goes there, as at the end of a level; all else stays.
   */
  void Revise(const LevelImage& image);

  /**
   * After Run(), before Result(), so that there is room for this: lets go of what Revise() would need.
   */
  void ForgetMotion();

  /**
   * After Result(): lets go of all but the mesh, which Divide() and Save() need, of the values of
   * the level. What it has of History(), Lost() and the like stays.
   */
  void LeaveLevel();

  /**
   * For the levels to come: before its final regularisation, delta is changed by small steps, as
   * far as eq. (7) allows, until the mean of the edges is this long (workspace; 0, the default: no
   * change). Within 3 % where eq. (7) does not end it.
   */
  void SetMeanEdgeLength(double length);

  /**
   * For the next level, which must be the last one: it is divided only where what is seen there asks for it, and with a tolerance edges become longer where it rests, as far as
   * it stays within that of the isopotential. Lengths: workspace.
   */
  void SetGrading(const Grading& grading);

  /**
   * Global division down to delta of a finer level; lost parts are enclosed again.
   * @return false if the monitor said stop before anything was done: surface and level are those
   *         of before.
   */
  bool Divide(const LevelImage& image, int level);

  /**
   * After LeaveLevel(): writes what the levels to come depend on, so that another object, in another
   * process too, can go on as this one would.
   * @throws FileError.
   */
  void Save(CheckedWriter& file) const;

  /**
   * Instead of a start, with the options of the one that saved it. Then divide it, or look at its
   * history and its counts; before that it has no Result(). @throws FileError, and then is of no
   * use any more.
   */
  void Load(CheckedReader& file);

  /** The surface as it is. */
  SurfaceResult Result() const;

  /** A row per iteration since the object was made. */
  const std::vector<HistoryRow>& History() const;

  /** Iterations on the level. */
  int Iterations() const;

  /** Whether the monitor has said stop. */
  bool IsStopped() const;

  /** When the run began, where that is earlier than this object: where the seconds start from. */
  void StartClock(std::chrono::steady_clock::time_point start);

  /**
   * To be called when all is done with the surface of a level. @return the seconds that have
   * passed since the level before, or since the start of the clock; those of the level's rows
   * add up to them (a level without an iteration has none).
   */
  double EndLevel();

  /** Lost parts that the last Divide() found, and how many of them it enclosed, if asked to. */
  struct LostParts
  {
    int Found = 0; ///< Parts of the object outside the surface; told also where recovery is off.
    int Enclosed = 0;
    int FoundCavities = 0; ///< Parts of the background inside it; looked for only on request.
    int EnclosedCavities = 0;
    int Missing = 0; ///< Of all found, those that the surface misses when Run() has ended.
    double MissingBoundary = 0.; ///< And the share of the whole boundary; see LostBoundary.
  };
  LostParts Lost() const;

  /**
   * What the exact tests of all faces have found at the end of the last Run() or Revise(): vertices
   * whose faces intersected others, 0 but for an error of Volumic, and how many of them are left
   * after the surface has got another mesh.
   */
  struct Verdict
  {
    int Found = 0;
    int Left = 0;
    /** What is told where something was found. */
    std::string Describe(int level) const;
  };
  Verdict Verified() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Self;
};
}

#endif
