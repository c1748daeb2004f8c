// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceGrowth.h"

#include "ChildRun.h"
#include "SurfaceTables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

namespace volumic
{
namespace bench
{
namespace
{

const std::vector<const char*> Columns = { "Size", "Voxels", "WallSeconds", "ProcessorSeconds",
  "PyramidSeconds", "BaseMegabytes", "PeakMegabytes", "GrownMegabytes", "Vertices", "Iterations",
  "VertexIterations", "MicrosecondsPerVertexIteration", "FinestIterations", "FinestSeconds",
  "FinestVertices" };

const char* const SearchPhases = "ContactAndProximity";

/** Of one phase, all levels; and per iteration of the finest. */
std::string PerIteration(const std::string& phase)
{
  return phase + "PerFinestIteration";
}

/** Adds what the tables tell beyond the figures of the run. */
void AddGrowthFigures(RunFigures& figures)
{
  figures.Set("GrownMegabytes", figures.Get("PeakMegabytes") - figures.Get("BaseMegabytes"));
  const auto finest = [&figures](const std::string& name)
  { return figures.Get(RunFigures::Indexed("level", 0, name)); };
  figures.Set("FinestIterations", finest("Iterations"));
  figures.Set("FinestSeconds", finest("Seconds"));
  figures.Set("FinestVertices", finest("VertexIterations") / finest("Iterations"));
  figures.Set(PerIteration("Finest"), finest("Seconds") / finest("Iterations"));
  for (const std::string& phase : PhasesOf(figures))
  {
    double sum = 0.0;
    for (int h = 0; h < static_cast<int>(figures.Get("Levels")); ++h)
    {
      sum += figures.Get(RunFigures::Indexed("level", h, phase));
    }
    figures.Set(phase, sum);
    figures.Set(PerIteration(phase), finest(phase) / finest("Iterations"));
  }
  // Both search for vertices that are near: one figure for what the paper calls O(n log n).
  figures.Set(PerIteration(SearchPhases),
    figures.Get(PerIteration("ContactSeconds")) + figures.Get(PerIteration("ProximitySeconds")));
}

std::vector<std::string> PhasesOfAll(const std::vector<SurfaceRunResult>& runs)
{
  for (const SurfaceRunResult& run : runs)
  {
    if (!PhasesOf(run.Figures).empty())
    {
      return PhasesOf(run.Figures);
    }
  }
  return {};
}

TextRows GrowthRows(const std::vector<SurfaceRunResult>& runs,
  const std::vector<std::string>& names, const std::function<std::string(double)>& text)
{
  TextRows rows(1, names);
  for (const SurfaceRunResult& run : runs)
  {
    std::vector<std::string> row;
    for (const std::string& name : names)
    {
      row.push_back(text(run.Figures.Get(name)));
    }
    rows.push_back(row);
  }
  return rows;
}

/** The table as it is, but figures along rows: sizes are fewer. */
TextRows Transposed(const TextRows& rows)
{
  TextRows turned(rows.front().size());
  for (std::size_t c = 0; c < turned.size(); ++c)
  {
    for (const auto& row : rows)
    {
      turned[c].push_back(row[c]);
    }
  }
  return turned;
}

TextRows ExponentRows(
  const std::vector<SurfaceRunResult>& runs, const std::vector<std::string>& phases)
{
  TextRows rows(1, { "Figure", "Against", "Exponent", "R2", "Sizes" });
  const auto values = [&runs](const std::string& name)
  {
    std::vector<double> list;
    for (const SurfaceRunResult& run : runs)
    {
      list.push_back(run.Figures.Get(name));
    }
    return list;
  };
  const auto add = [&](const std::string& figure, const std::string& against)
  {
    const PowerLaw law = FitPowerLaw(values(against), values(figure));
    rows.push_back({ figure, against, ShortText(law.Exponent), ShortText(law.Determination),
      std::to_string(law.Samples) });
  };
  for (const char* against : { "Voxels", "Vertices" })
  {
    for (const char* figure :
      { "WallSeconds", "ProcessorSeconds", "PyramidSeconds", "PeakMegabytes", "GrownMegabytes" })
    {
      add(figure, against);
    }
  }
  add("Vertices", "Voxels");
  add(PerIteration("Finest"), "FinestVertices");
  for (const std::string& phase : phases)
  {
    // What happens between iterations has no share of one.
    add(phase == BetweenIterations ? phase : PerIteration(phase),
      phase == BetweenIterations ? "Vertices" : "FinestVertices");
  }
  if (!phases.empty())
  {
    add(PerIteration(SearchPhases), "FinestVertices");
  }
  return rows;
}

} // namespace

//------------------------------------------------------------------------------
PowerLaw FitPowerLaw(const std::vector<double>& x, const std::vector<double>& y)
{
  std::vector<double> u, v;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
  {
    if (std::isfinite(x[i]) && std::isfinite(y[i]) && x[i] > 0.0 && y[i] > 0.0)
    {
      u.push_back(std::log(x[i]));
      v.push_back(std::log(y[i]));
    }
  }
  PowerLaw law;
  law.Samples = static_cast<int>(u.size());
  double meanU = 0.0, meanV = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    meanU += u[i] / u.size();
    meanV += v[i] / v.size();
  }
  double uu = 0.0, uv = 0.0, vv = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i)
  {
    uu += (u[i] - meanU) * (u[i] - meanU);
    uv += (u[i] - meanU) * (v[i] - meanV);
    vv += (v[i] - meanV) * (v[i] - meanV);
  }
  const bool isKnown = law.Samples >= 2 && uu > 0.0;
  law.Exponent = isKnown ? uv / uu : std::numeric_limits<double>::quiet_NaN();
  law.Determination =
    isKnown && vv > 0.0 ? uv * uv / (uu * vv) : std::numeric_limits<double>::quiet_NaN();
  return law;
}

bool MeasureGrowth(const SurfaceBenchmarkOptions& options)
{
  std::vector<SurfaceRunResult> runs;
  bool allWell = true;
  for (const int size : options.Sizes)
  {
    std::fprintf(stderr, "%d^3\n", size);
    SurfaceBenchmarkOptions one = OursAt(options, "us-1", size);
    one.Profile = true;
    RunFigures figures = RunAsChild(ArgumentsOfRun(one));
    if (const std::string failure = figures.GetText("Failure"); !failure.empty())
    {
      std::fprintf(stderr, "%d^3 failed: %s\n", size, failure.c_str());
      allWell = false;
      continue;
    }
    figures.Set("Size", size);
    AddGrowthFigures(figures);
    runs.push_back({ "us-1", figures });
  }
  if (runs.empty())
  {
    return false;
  }
  AddDerivedFigures(runs);

  const std::vector<std::string> phases = PhasesOfAll(runs);
  std::vector<std::string> names(Columns.begin(), Columns.end());
  names.insert(names.end(), phases.begin(), phases.end());
  std::printf(
    "\nHow cost grows: us-1; Finest is what concerns level 0 alone, FinestVertices the "
    "mean over its iterations; GrownMegabytes is the peak less what was there before.\n\n");
  PrintTable(Transposed(GrowthRows(runs, names, [](double value) { return ShortText(value, 4); })));
  const TextRows exponents = ExponentRows(runs, phases);
  std::printf("\nFitted exponents, least squares of the logarithms:\n\n");
  PrintTable(exponents, 2);
  if (!options.Csv.empty())
  {
    for (const std::string& phase : phases)
    {
      if (phase != BetweenIterations)
      {
        names.push_back(PerIteration(phase));
      }
    }
    names.push_back(PerIteration(SearchPhases));
    names.push_back(PerIteration("Finest"));
    WriteCsv(options.Csv, GrowthRows(runs, names, ExactText));
    WriteCsv(CsvNameOf(options.Csv, "exponents"), exponents);
  }
  return allWell;
}

} // namespace bench
} // namespace volumic
