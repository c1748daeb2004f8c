// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The tables of BenchmarkLabels, for people and as CSV, and what became of the targets. */

#ifndef volumicLabelTables_h
#define volumicLabelTables_h

#include "SurfaceTables.h"

#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

/** One run on one label, or, AllLabels, what is measured of all of them together. */
struct LabelRow
{
  static constexpr int AllLabels = -100000;

  std::string Map;
  int Label = AllLabels;
  std::string Run;
  RunFigures Figures; ///< the text Failure where there are none
};

/** A row per run and label. */
void PrintLabelRows(const std::vector<LabelRow>& rows);

/** A row per run: sums and the worst over the labels; then the labels that ours is worst at. */
void PrintLabelSummary(const std::vector<LabelRow>& rows);

TextRows LabelCsvRows(const std::vector<LabelRow>& rows);

/** Of issue 17, as TargetRows: the worst over all rows, and where that is. */
TextRows LabelTargetRows(const std::vector<LabelRow>& rows);

} // namespace bench
} // namespace volumic

#endif
