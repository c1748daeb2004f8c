// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMonitor_h
#define volumicMonitor_h

namespace volumic
{
/**
 * Progress out, cancel in. The core asks after every iteration; it never sees its host.
 * The default listens to nothing and never cancels.
 */
class Monitor
{
public:
  struct Status
  {
    int Level = 0;           ///< Level that is running; 0 is the finest.
    int Iteration = 0;       ///< Iterations done on this level.
    int Vertices = 0;        ///< Vertices of the surface now.
    int ActiveVertices = 0;  ///< Of them, those that are awake.
    double Fraction = 0;     ///< Estimate of the share of this level that is done, in [0, 1].
  };

  virtual ~Monitor() = default;

  /**
   * False asks the evolution to stop after this iteration. The surface is then handed over as it
   * is: closed, manifold and free of self-intersections.
   */
  virtual bool Continue(const Status&) { return true; }
};
}

#endif
