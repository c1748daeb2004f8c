// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankMeasures_h
#define volumicRankMeasures_h

#include "Core/Common/ExactSum.h"
#include "Core/Common/Executor.h"
#include "Core/Surface/RankPart.h"
#include "Core/Surface/SurfaceState.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace volumic
{
/**
 * The sum of termOf(v) over the own vertices of all ranks, on all of them: the same bits for any
 * ranks and executor, see ExactSum. Cost: O(vertices), a short message of each rank.
 */
double SumOverRanks(const RankPart& part, const SurfaceMesh& mesh, Executor& executor,
  const std::function<double(int v)>& termOf);
/** The same for what this rank has added up itself. */
double SumOverRanks(Communicator& ranks, const ExactSum& sum);

/** How much of a surface there is on all ranks together. */
struct SurfaceCounts
{
  std::int64_t Vertices = 0;
  std::int64_t Edges = 0;

  std::int64_t EulerCharacteristic() const { return this->Vertices - this->Edges / 3; }
};
SurfaceCounts CountOverRanks(const RankPart& part, const SurfaceMesh& mesh, Executor& executor);

/** As EnclosedVolume and SurfaceArea, but for rounding, on all ranks. */
double EnclosedVolume(const RankPart& part, const SurfaceMesh& mesh, Executor& executor);
double SurfaceArea(const RankPart& part, const SurfaceMesh& mesh, Executor& executor);

/** Workspace; of the shapes as they are (SurfaceState::EdgeLengthSum). 0 without edges. */
double MeanEdgeLength(const RankPart& part, const SurfaceState& state, Executor& executor);
}

#endif
