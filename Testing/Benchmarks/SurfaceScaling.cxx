// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceScaling.h"

#include "ChildRun.h"
#include "SurfaceTables.h"
#include "SurfaceTargets.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

namespace volumic
{
namespace bench
{
namespace
{

/** The lower one of two in the middle; NaN of none. */
double Median(std::vector<double> values)
{
  if (values.empty())
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/** A run that has failed is told, and null. */
bool HasFailed(const std::string& what, const RunFigures& figures)
{
  const std::string failure = figures.GetText("Failure");
  if (!failure.empty())
  {
    std::fprintf(stderr, "%s failed: %s\n", what.c_str(), failure.c_str());
  }
  return !failure.empty();
}

void Finish(const SurfaceBenchmarkOptions& options, const TextRows& table, const TextRows& csv,
  const TextRows& targets)
{
  std::printf("\n");
  PrintTable(table);
  std::printf("\nTargets:\n\n");
  PrintTable(targets, 2);
  if (!options.Csv.empty())
  {
    WriteCsv(options.Csv, csv);
    WriteCsv(CsvNameOf(options.Csv, "targets"), targets);
  }
}

//------------------------------------------------------------------------------
/** The rounds of one size. */
struct Rounds
{
  std::map<int, std::vector<double>> Seconds; ///< by number of threads, in the order of the rounds
  double Voxels = 0.0;
  bool Differ = false; ///< the surfaces
  bool AllWell = true;
  std::string Fingerprint;
};

Rounds RunRounds(const SurfaceBenchmarkOptions& options, int size, TextRows& csv)
{
  Rounds rounds;
  for (int round = 0; round < options.Repetitions && rounds.AllWell; ++round)
  {
    // To and fro, so that a machine that gets slower favours none.
    std::vector<int> order = options.Threads;
    if (round % 2 == 1)
    {
      std::reverse(order.begin(), order.end());
    }
    for (const int threads : order)
    {
      const std::string name = "us-" + std::to_string(threads);
      std::fprintf(
        stderr, "%s, %s, round %d\n", name.c_str(), NameOfSize(size).c_str(), round + 1);
      const RunFigures figures = RunAsChild(ArgumentsOfRun(OursAt(options, name, size)));
      if (HasFailed(name, figures))
      {
        rounds.AllWell = false;
        break;
      }
      const std::string fingerprint = figures.GetText("Fingerprint");
      rounds.Differ =
        rounds.Differ || (!rounds.Fingerprint.empty() && rounds.Fingerprint != fingerprint);
      rounds.Fingerprint = fingerprint;
      rounds.Voxels = figures.Get("Voxels");
      rounds.Seconds[threads].push_back(figures.Get("WallSeconds"));
      csv.push_back({ std::to_string(size), std::to_string(threads), std::to_string(round + 1),
        ExactText(figures.Get("WallSeconds")), ExactText(figures.Get("ProcessorSeconds")),
        fingerprint });
    }
  }
  return rounds;
}

/** Of the rounds that are complete. */
double MedianGain(const Rounds& rounds, int one, int other)
{
  std::vector<double> gains;
  const std::vector<double>& first = rounds.Seconds.at(one);
  const std::vector<double>& second = rounds.Seconds.at(other);
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i)
  {
    gains.push_back(first[i] / second[i]);
  }
  return Median(gains);
}

//------------------------------------------------------------------------------
/** A folder that goes away with all that is in it. */
class ScratchFolder
{
public:
  ScratchFolder()
  {
    std::string pattern = (std::filesystem::temp_directory_path() / "volumic-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
    {
      throw std::runtime_error(pattern + ": can't be made");
    }
    this->Path = pattern;
  }
  ~ScratchFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string File(const std::string& name) const { return (this->Path / name).string(); }

private:
  std::filesystem::path Path;
};

RunFigures MeasurePeak(const SurfaceBenchmarkOptions& options, int size)
{
  const ScratchFolder folder;
  SurfaceBenchmarkOptions write = OursAt(options, "us-1", size);
  write.WriteVolume = folder.File("volume.vti");
  const RunFigures written = RunAsChild(ArgumentsOfRun(write));
  if (HasFailed("writing " + NameOfSize(size), written))
  {
    return written;
  }
  SurfaceBenchmarkOptions run = OursAt(options, "us-1", 0);
  run.Volume = write.WriteVolume;
  run.Scene.clear();
  run.IsoValue = written.Get("IsoValue");
  RunFigures figures = RunAsChild(ArgumentsOfRun(run));
  figures.Set("BytesOfVoxel", written.Get("BytesOfVoxel"));
  return figures;
}

/** M1 has a limit for two sizes of two bytes a voxel. */
double LimitOfPeak(int size, double bytesOfVoxel)
{
  const bool isMeant = bytesOfVoxel == 2.0;
  return isMeant && size == 512 ? 800.0 : isMeant && size == 1024 ? 5000.0 : 0.0;
}

} // namespace

//------------------------------------------------------------------------------
bool MeasureThreads(const SurfaceBenchmarkOptions& options)
{
  const int first = options.Threads.front();
  TextRows csv(
    1, { "Size", "Threads", "Round", "WallSeconds", "ProcessorSeconds", "Fingerprint" });
  TextRows table(1, { "volume", "threads", "rounds", "median seconds", "least", "most", "gain" });
  TextRows targets(1, TargetHeading());
  bool allWell = true;
  for (const int size : options.Sizes)
  {
    const Rounds rounds = RunRounds(options, size, csv);
    allWell = allWell && rounds.AllWell;
    if (!rounds.AllWell)
    {
      continue;
    }
    for (const auto& [threads, seconds] : rounds.Seconds)
    {
      const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
      const double gain = MedianGain(rounds, first, threads);
      table.push_back({ NameOfSize(size), std::to_string(threads), std::to_string(seconds.size()),
        ShortText(Median(seconds)), ShortText(*least), ShortText(*most), ShortText(gain) });
      if (first == 1 && threads == 2)
      {
        targets.push_back(TargetRow("S6", NameOfSize(size) + ", seconds of 1 thread / of 2", gain,
          Bound::AtLeast, rounds.Voxels > LargeVolume ? 1.85 : 1.75));
      }
    }
    targets.push_back(TargetRow("Q5", NameOfSize(size) + ", surfaces that differ",
      rounds.Differ ? 1.0 : 0.0, Bound::AtMost, 0.0));
  }
  std::printf("\nSeconds of the clock, pyramid included; gain: median over the rounds of the "
              "seconds with %d over those in the same round.\n",
    first);
  Finish(options, table, csv, targets);
  return allWell;
}

bool MeasurePeaks(const SurfaceBenchmarkOptions& options)
{
  TextRows csv(1,
    { "Size", "Voxels", "BytesOfVoxel", "BaseMegabytes", "PeakMegabytes", "WallSeconds",
      "ProcessorSeconds", "Vertices" });
  TextRows table(1, { "volume", "voxels", "MB of them", "MB before", "MB at the peak", "vertices" });
  TextRows targets(1, TargetHeading());
  bool allWell = true;
  for (const int size : options.Sizes)
  {
    const std::string volume = NameOfSize(size);
    std::fprintf(stderr, "us-1, %s\n", volume.c_str());
    const RunFigures figures = MeasurePeak(options, size);
    if (HasFailed(volume, figures))
    {
      allWell = false;
      continue;
    }
    const double voxels = figures.Get("Voxels");
    const double bytes = figures.Get("BytesOfVoxel");
    const double peak = figures.Get("PeakMegabytes");
    table.push_back({ volume, ShortText(voxels), ShortText(1e-6 * bytes * voxels, 4),
      ShortText(figures.Get("BaseMegabytes"), 4), ShortText(peak, 4),
      ShortText(figures.Get("Vertices")) });
    csv.push_back({ std::to_string(size) });
    for (std::size_t c = 1; c < csv.front().size(); ++c)
    {
      csv.back().push_back(ExactText(figures.Get(csv.front()[c])));
    }
    if (const double limit = LimitOfPeak(size, bytes); limit > 0.0)
    {
      targets.push_back(
        TargetRow("M1", volume + " of int16, MB at the peak", peak, Bound::AtMost, limit));
    }
  }
  std::printf("\nResident memory of the whole process: libraries, image and run.\n");
  Finish(options, table, csv, targets);
  return allWell;
}

} // namespace bench
} // namespace volumic
