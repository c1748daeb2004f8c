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
/** Resulting surface: compact arrays, computational space. */
struct SurfaceResult : IndexedSurface
{
  LargeVector<std::array<float, 3>> Normals; ///< unit vectors, outward, per point
  LargeVector<float> Residual;               ///< field minus iso-value, per point
  LargeVector<unsigned char> Motionless;     ///< 1: converged, per point
  LargeVector<unsigned char> Held;           ///< per point, see RemainingContacts
  LargeVector<std::array<int, 2>> Contacts;  ///< pairs of points, see RemainingContacts
  double Delta = 0.;                         ///< delta_h
  LargeVector<float> Size;                   ///< delta per point of a graded surface, else empty
  LargeVector<float> Thickness;              ///< per point with thin parts, else empty
  std::optional<Fit> FitToTolerance;         ///< with a tolerance, after convergence

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

/** Create the result of a surface between sweeps, whose grid is up to date. */
SurfaceResult MakeResult(
  SurfaceState& state, const Field& field, const Grading& grading, Executor& executor);
}

#endif
