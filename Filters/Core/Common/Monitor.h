// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMonitor_h
#define volumicMonitor_h

#include <functional>

namespace volumic
{
/**
 * By which work asks, now and then, whether to go on: it tells the share of it that is done, in
 * [0, 1]; the answer false means stop. Asked on the thread that does the work, never from within an
 * executor.
 */
using ProgressCallback = std::function<bool(double share)>;

/** For work that nobody follows. */
inline bool NeverStop(double)
{
  return true;
}

/**
 * Progress out, cancel in: the only way in which the core hears of its host, which it never sees.
 * The default listens to nothing and never cancels. Who wants to end a run for any other reason,
 * such as the time it takes, says so here too.
 */
class Monitor
{
public:
  /** What is being done. */
  enum class Activity
  {
    Starting,
    Dividing,
    Recovering, ///< Looking for what coarser levels have lost.
    Iterating,
    Regularising
  };

  struct Status
  {
    int Level = 0; ///< Level that is running; 0 is the finest.
    Activity Doing = Activity::Iterating;
    int Iteration = 0;      ///< Iterations done on this level.
    int Sweep = 0;          ///< Number of the level's sweep, from 1; 0 before the first.
    int Block = 0;          ///< Blocks that were visited in this sweep, and
    int Blocks = 0;         ///< how many there are at most.
    int Vertices = 0;       ///< Vertices of the surface now.
    int ActiveVertices = 0; ///< How many of them are not frozen.
    double Fraction = 0;    ///< Estimate of the share of this level that is done, in [0, 1]. It
                            ///< never becomes less.
  };

  virtual ~Monitor() = default;

  /**
   * Asked within, before and after the iterations, several times a second; the surface is in
   * work. False asks to stop as soon as it is closed, manifold and free of self-intersections, as
   * which it is then handed over. After that it is not asked again.
   */
  virtual bool GoOn(const Status&) { return true; }
};
}

#endif
