// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceResult_h
#define volumicSurfaceResult_h

#include "Core/Common/Executor.h"
#include "Core/Common/Grading.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <optional>

namespace volumic
{
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

  /** Call visit(list) for each list with one entry per point (some are empty). */
  template <typename Visit>
  void VisitPoints(const Visit& visit)
  {
    visit(this->Points);
    visit(this->Normals);
    visit(this->Residual);
    visit(this->Motionless);
    visit(this->Held);
    visit(this->Size);
    visit(this->Thickness);
  }
};

/** Of a surface between sweeps, whose grid is up to date. The same for any executor. */
SurfaceResult MakeResult(
  SurfaceState& state, const Field& field, const Grading& grading, Executor& executor);
}

#endif
