// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The tables of BenchmarkSurface, for people and as CSV. */

#ifndef volumicSurfaceTables_h
#define volumicSurfaceTables_h

#include "RunFigures.h"

#include <array>
#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

struct SurfaceRunResult
{
  std::string Name;
  RunFigures Figures;
};

/** Null where there is none. */
const SurfaceRunResult* FindRun(const std::vector<SurfaceRunResult>& runs, const std::string& name);

using TextRows = std::vector<std::vector<std::string>>;

/** To the standard output, first row underlined, the first `leftColumns` columns to the left, all
    others to the right. */
void PrintTable(const TextRows& rows, std::size_t leftColumns = 1);

/** Adds what follows from the other figures: WallRatio and ProcessorRatio to us-1, EdgesOutside,
    and MicrosecondsPerVertexIteration (of the processor, all included; of the clock for levels). */
void AddDerivedFigures(std::vector<SurfaceRunResult>& runs);

/** A column per run, a row per figure. */
void PrintRuns(const std::vector<SurfaceRunResult>& runs);
/** A row per run. */
TextRows RunRows(const std::vector<SurfaceRunResult>& runs);

/** The levels of a run of ours: a column per level, a row per figure. */
void PrintLevels(const RunFigures& ours);
/** A row per level, with all phases that there are. */
TextRows LevelRows(const RunFigures& ours);

/** Seconds by level and phase, their share of the whole run, microseconds per vertex and iteration.
 */
void PrintProfile(const RunFigures& ours);

/** The phase that the seconds of iterations do not include. */
constexpr const char* BetweenIterations = "DivisionSeconds";

/** Names of the phases' figures that add up, none without a profile. */
std::vector<std::string> PhasesOf(const RunFigures& ours);

/** Those that are parts of BetweenIterations. */
constexpr std::array<const char*, 2> PartsBetweenIterations = { "RecoverySeconds",
  "RegularisationSeconds" };

/** The figure of a phase that tells what one thread did alone. */
std::string SerialOf(const std::string& phase);

} // namespace bench
} // namespace volumic

#endif
