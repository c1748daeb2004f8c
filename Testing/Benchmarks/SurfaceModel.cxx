// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceModel.h"

#include "ChildRun.h"
#include "SurfaceTables.h"
#include "SurfaceTargets.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace volumic
{
namespace bench
{
namespace
{

constexpr int TargetThreads = 16;

const char* const Assumptions =
  R"(us-1 ran on one thread. Each For() was cut into the chunks that StandardThreads makes for 64
threads, 8 per thread, none smaller than its grain; each chunk's time is that of the processor, less
what reading the clock takes. For fewer threads neighbouring chunks are put together. Threads take
chunks in order, each when it is free. Added: %g us per For(), %g us per chunk. All between the
calls, and a For() of no more than its grain ("small"), is serial and added as it is. Left out: that
processors share memory and caches, and slow down when all of them work. A phase holds what happens
up to its end since the one before has ended, in iterations and regularisations of all levels.
Seconds by phase on 1, 2 ... 64 threads; what is longest on %d of them is first.
)";

std::string ModelName(std::size_t i, const std::string& name)
{
  return RunFigures::Indexed("model", static_cast<int>(i), name);
}

std::string ScheduledName(int threads)
{
  return "Scheduled" + std::to_string(threads);
}

std::size_t PlaceOf(int threads)
{
  return static_cast<std::size_t>(
    std::find(ModelledThreads.begin(), ModelledThreads.end(), threads) - ModelledThreads.begin());
}

double SecondsOfOne(const WorkModel::Phase& phase)
{
  return phase.Serial + phase.Parallel;
}

double SecondsOf(const WorkModel::Phase& phase, std::size_t place)
{
  return phase.Serial + phase.Scheduled[place];
}

/** The phases, what is longest on TargetThreads first, and their sum. */
std::vector<WorkModel::Phase> SortedWithSum(std::vector<WorkModel::Phase> phases)
{
  const std::size_t place = PlaceOf(TargetThreads);
  std::stable_sort(phases.begin(), phases.end(),
    [place](const WorkModel::Phase& a, const WorkModel::Phase& b)
    { return SecondsOf(a, place) > SecondsOf(b, place); });
  WorkModel::Phase sum;
  sum.Name = "all";
  for (const WorkModel::Phase& phase : phases)
  {
    sum += phase;
  }
  phases.push_back(sum);
  return phases;
}

/** For people, seconds and the speed-up. */
TextRows ModelRows(const std::vector<WorkModel::Phase>& sorted)
{
  TextRows rows(1, { "phase", "serial", "% of all", "small", "parallel", "calls", "1" });
  const WorkModel::Phase& sum = sorted.back();
  const double all = SecondsOfOne(sum);
  for (const WorkModel::Phase& phase : sorted)
  {
    rows.push_back({ phase.Name, ShortText(phase.Serial), ShortText(100.0 * phase.Serial / all),
      ShortText(phase.Small), ShortText(phase.Parallel), ShortText(phase.Calls), ShortText(SecondsOfOne(phase)) });
    for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
    {
      rows.back().push_back(ShortText(SecondsOf(phase, i)));
    }
  }
  rows.push_back({ "speed-up", "", "", "", "", "", "1" });
  for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
  {
    rows[0].push_back(std::to_string(ModelledThreads[i]));
    rows.back().push_back(ShortText(all / SecondsOf(sum, i)));
  }
  return rows;
}

void AddCsvRows(int size, const std::string& fingerprint,
  const std::vector<WorkModel::Phase>& sorted, TextRows& rows)
{
  if (rows.empty())
  {
    rows.push_back({ "Size", "Phase", "Serial", "Small", "Parallel", "Calls", "Chunks", "Seconds1" });
    for (const int threads : ModelledThreads)
    {
      rows[0].push_back("Seconds" + std::to_string(threads));
    }
    rows[0].push_back("Fingerprint");
  }
  for (const WorkModel::Phase& phase : sorted)
  {
    rows.push_back({ std::to_string(size), phase.Name, ExactText(phase.Serial),
      ExactText(phase.Small), ExactText(phase.Parallel), ExactText(phase.Calls), ExactText(phase.Chunks),
      ExactText(SecondsOfOne(phase)) });
    for (std::size_t i = 0; i < ModelledThreads.size(); ++i)
    {
      rows.back().push_back(ExactText(SecondsOf(phase, i)));
    }
    rows.back().push_back(fingerprint);
  }
}

void AddTargets(
  const std::string& volume, double voxels, const WorkModel::Phase& sum, TextRows& rows)
{
  const bool isLarge = voxels > LargeVolume;
  rows.push_back(TargetRow("S6",
    volume + ", modelled speed-up on " + std::to_string(TargetThreads) + " threads",
    SecondsOfOne(sum) / SecondsOf(sum, PlaceOf(TargetThreads)), Bound::AtLeast,
    isLarge ? 8.0 : 5.0));
  if (isLarge)
  {
    rows.push_back(TargetRow("S6", volume + ", serial share, %",
      100.0 * sum.Serial / SecondsOfOne(sum), Bound::AtMost, 5.0));
  }
}

} // namespace

//------------------------------------------------------------------------------
void SetModel(const WorkModel& model, RunFigures& figures)
{
  const std::vector<WorkModel::Phase>& phases = model.Phases();
  figures.Set("ModelPhases", static_cast<double>(phases.size()));
  for (std::size_t i = 0; i < phases.size(); ++i)
  {
    figures.SetText(ModelName(i, "Name"), phases[i].Name);
    figures.Set(ModelName(i, "Serial"), phases[i].Serial);
    figures.Set(ModelName(i, "Small"), phases[i].Small);
    figures.Set(ModelName(i, "Parallel"), phases[i].Parallel);
    figures.Set(ModelName(i, "Calls"), phases[i].Calls);
    figures.Set(ModelName(i, "Chunks"), phases[i].Chunks);
    for (std::size_t t = 0; t < ModelledThreads.size(); ++t)
    {
      figures.Set(ModelName(i, ScheduledName(ModelledThreads[t])), phases[i].Scheduled[t]);
    }
  }
}

std::vector<WorkModel::Phase> ModelOf(const RunFigures& figures)
{
  std::vector<WorkModel::Phase> phases(
    figures.Has("ModelPhases") ? static_cast<std::size_t>(figures.Get("ModelPhases")) : 0);
  for (std::size_t i = 0; i < phases.size(); ++i)
  {
    phases[i].Name = figures.GetText(ModelName(i, "Name"));
    phases[i].Serial = figures.Get(ModelName(i, "Serial"));
    phases[i].Small = figures.Get(ModelName(i, "Small"));
    phases[i].Parallel = figures.Get(ModelName(i, "Parallel"));
    phases[i].Calls = figures.Get(ModelName(i, "Calls"));
    phases[i].Chunks = figures.Get(ModelName(i, "Chunks"));
    for (std::size_t t = 0; t < ModelledThreads.size(); ++t)
    {
      phases[i].Scheduled[t] = figures.Get(ModelName(i, ScheduledName(ModelledThreads[t])));
    }
  }
  return phases;
}

bool MeasureModel(const SurfaceBenchmarkOptions& options)
{
  const ThreadOverhead overhead;
  std::printf("\n");
  std::printf(
    Assumptions, 1e6 * overhead.SecondsOfCall, 1e6 * overhead.SecondsOfChunk, TargetThreads);
  TextRows csv;
  TextRows targets(1, TargetHeading());
  bool allWell = true;
  for (const int size : options.Sizes)
  {
    const std::string volume = NameOfSize(size);
    std::fprintf(stderr, "us-1, %s\n", volume.c_str());
    const RunFigures figures = RunAsChild(ArgumentsOfRun(OursAt(options, "us-1", size)));
    if (const std::string failure = figures.GetText("Failure"); !failure.empty())
    {
      std::fprintf(stderr, "%s failed: %s\n", volume.c_str(), failure.c_str());
      allWell = false;
      continue;
    }
    const std::vector<WorkModel::Phase> sorted = SortedWithSum(ModelOf(figures));
    std::printf("\nThe volume %s:\n\n", volume.c_str());
    PrintTable(ModelRows(sorted));
    std::fflush(stdout);
    AddCsvRows(size, figures.GetText("Fingerprint"), sorted, csv);
    AddTargets(volume, figures.Get("Voxels"), sorted.back(), targets);
  }
  std::printf("\nTargets:\n\n");
  PrintTable(targets, 2);
  if (!options.Csv.empty())
  {
    WriteCsv(options.Csv, csv);
    WriteCsv(CsvNameOf(options.Csv, "targets"), targets);
  }
  return allWell;
}

} // namespace bench
} // namespace volumic
