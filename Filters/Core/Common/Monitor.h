// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMonitor_h
#define volumicMonitor_h

#include <functional>

namespace volumic
{
/**
 * Progress callback: receives the fraction done, in [0, 1]; returns false to cancel. Called on the
 * thread that runs the algorithm, never within a parallel loop.
 */
using ProgressCallback = std::function<bool(double share)>;

/** ProgressCallback that never cancels. */
inline bool NeverStop(double)
{
  return true;
}

/**
 * Interface between the core and its host: reports progress, and cancels a run for any reason, such
 * as a time limit. The default never cancels.
 */
class Monitor
{
public:
  enum class Activity
  {
    Starting,
    Dividing,
    Recovering, ///< searching features missed by coarser levels
    Iterating,
    Regularising
  };

  struct Status
  {
    int Level = 0; ///< current level; 0 is the finest
    Activity Doing = Activity::Iterating;
    int Iteration = 0;      ///< iterations done at this level
    int Sweep = 0;          ///< sweep of the level, from 1; 0 before the first
    int Block = 0;          ///< block passes done in this sweep
    int Blocks = 0;         ///< largest number of block passes in this sweep
    int Vertices = 0;       ///< current number of vertices
    int ActiveVertices = 0; ///< vertices that have not converged
    double Fraction = 0;    ///< estimated fraction of this level, in [0, 1]; never decreases
  };

  virtual ~Monitor() = default;

  /**
   * Return false to cancel. Called several times a second, while the surface may be incomplete. The
   * run then ends as soon as the surface is closed, manifold and free of self-intersections. It
   * does not call this method again.
   */
  virtual bool GoOn(const Status&) { return true; }
};
}

#endif
