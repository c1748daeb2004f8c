// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * vtkDeformableSurface and its peers on one volume, side by side: seconds, memory, and quality
 * judged by the same code for all; then what became of the targets.
 *
 *     BenchmarkSurface --volume FILE.vti --iso VALUE [--runs LIST] [--slow] [--no-recovery]
 *                      [--repetitions N] [--profile] [--csv FILE.csv] [--output FILE.vtp]
 *     BenchmarkSurface --volume FILE.vti --iso VALUE --growth [--sizes LIST | --max-size N]
 *     BenchmarkSurface --volume FILE.vti --iso VALUE --threads 1,2 | --model | --memory
 *                      [--sizes LIST] [--csv FILE.csv]
 *     BenchmarkSurface --help
 *
 * Peers: FlyingEdges; its largest component smoothed; that decimated, or remeshed by CGAL, to our
 * number of vertices or mean edge; CGAL's mesher; with --slow ITK's level set, where ITK was found.
 * All are given the volume with a voxel of air around it and work in voxels.
 *
 * Each run is a process of its own: this program starts itself with --run NAME, and reads figures
 * from what that writes. Loading is not measured, the pyramid is. Memory is that of the whole
 * process at its peak, libraries and volume included; what it was before is told beside it.
 *
 * Peers that are told how fine to be run after us-1. CGAL's mesher knows no number of vertices:
 * where it misses ours by more than 5 % it runs again with a radius that makes up for it, at most
 * twice.
 */

#include "ChildRun.h"
#include "SurfaceBenchmarkOptions.h"
#include "SurfaceBenchmarkVolume.h"
#include "SurfaceGrowth.h"
#include "SurfaceModel.h"
#include "SurfacePeers.h"
#include "SurfaceRuns.h"
#include "SurfaceScaling.h"
#include "SurfaceTables.h"
#include "SurfaceTargets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>

using namespace volumic::bench;

namespace
{

/** One run, in this process; its figures to the standard output. */
int RunHere(const SurfaceBenchmarkOptions& options)
{
  EndWithParent();
  try
  {
    const RunFigures figures =
      options.WriteVolume.empty() ? MeasureSurfaceRun(options) : WriteVolume(options);
    figures.Write(std::cout);
    return 0;
  }
  catch (const std::exception& error)
  {
    RunFigures figures;
    figures.SetText("Failure", error.what());
    figures.Write(std::cout);
    return 1;
  }
}

/** The run of median processor time of several. */
RunFigures Repeated(const SurfaceBenchmarkOptions& options)
{
  std::vector<RunFigures> runs;
  bool differ = false;
  for (int i = 0; i < options.Repetitions; ++i)
  {
    std::fprintf(stderr, "%s%s\n", options.Run.c_str(), i > 0 ? " again" : "");
    runs.push_back(RunAsChild(ArgumentsOfRun(options)));
    if (!runs.back().GetText("Failure").empty())
    {
      std::fprintf(
        stderr, "%s failed: %s\n", options.Run.c_str(), runs.back().GetText("Failure").c_str());
      return runs.back();
    }
    differ = differ || runs.back().GetText("Fingerprint") != runs.front().GetText("Fingerprint");
  }
  const auto median = runs.begin() + (runs.size() - 1) / 2;
  std::nth_element(runs.begin(), median, runs.end(),
    [](const RunFigures& a, const RunFigures& b)
    { return a.Get("ProcessorSeconds") < b.Get("ProcessorSeconds"); });
  median->Set("Repetitions", static_cast<double>(runs.size()));
  median->Set("RepetitionsDiffer", differ);
  return *median;
}

RunFigures MesherOfOurSize(SurfaceBenchmarkOptions options)
{
  const int tries = 3;
  const double target = static_cast<double>(options.Vertices);
  if (options.Radius <= 0.0)
  {
    options.Radius = MesherRadius(options.EdgeLength);
  }
  for (int i = 1;; ++i)
  {
    const RunFigures figures = Repeated(options);
    const double share = figures.Get("Vertices") / target;
    if (i == tries || !(share > 0.0) || std::fabs(share - 1.0) <= 0.05)
    {
      return figures;
    }
    options.Radius *= std::sqrt(share); // the number goes with the inverse square
  }
}

std::vector<std::string> RunsToMake(const SurfaceBenchmarkOptions& options)
{
  if (!options.Runs.empty())
  {
    return options.Runs;
  }
  std::vector<std::string> names;
  for (const SurfaceRunKind& kind : SurfaceRunKinds())
  {
    if ((!kind.Slow || options.Slow) &&
      (!kind.OnDemand || (options.NoRecovery && kind.Name == "us-paper")))
    {
      names.push_back(kind.Name);
    }
  }
  return names;
}

bool FollowsOurs(const std::string& name)
{
  const std::vector<SurfaceRunKind> kinds = SurfaceRunKinds();
  return std::any_of(kinds.begin(), kinds.end(),
    [&name](const SurfaceRunKind& kind) { return kind.Name == name && kind.NeedsOurs; });
}

bool KnowsSizes(const SurfaceBenchmarkOptions& options)
{
  return options.EdgeLength > 0.0 && options.Vertices > 0;
}

void CheckThatSizesWillBeKnown(
  const std::vector<std::string>& names, const SurfaceBenchmarkOptions& options)
{
  bool known = KnowsSizes(options);
  for (const std::string& name : names)
  {
    known = known || name == "us-1";
    if (FollowsOurs(name) && !known)
    {
      throw UsageError(name +
        " follows the surface of us-1: let that run before, or give both "
        "--edge-length and --vertices");
    }
  }
}

RunFigures RunOne(const SurfaceBenchmarkOptions& options)
{
  if (FollowsOurs(options.Run) && !KnowsSizes(options))
  {
    RunFigures figures;
    figures.SetText("Failure", "not run, as us-1 failed, whose surface it follows");
    return figures;
  }
  return options.Run == "mesher" ? MesherOfOurSize(options) : Repeated(options);
}

std::vector<SurfaceRunResult> RunAll(
  const std::vector<std::string>& names, SurfaceBenchmarkOptions options)
{
  std::vector<SurfaceRunResult> runs;
  const std::string output = options.Output;
  for (const std::string& name : names)
  {
    options.Run = name;
    options.Output = name == "us-1" ? output : "";
    const RunFigures figures = RunOne(options);
    if (name == "us-1" && figures.GetText("Failure").empty())
    {
      options.EdgeLength = options.EdgeLength > 0.0 ? options.EdgeLength : figures.Get("EdgeMean");
      options.Vertices =
        options.Vertices > 0 ? options.Vertices : std::llround(figures.Get("Vertices"));
    }
    runs.push_back({ name, figures });
  }
  return runs;
}

int RunSideBySide(const SurfaceBenchmarkOptions& options)
{
  const std::vector<std::string> names = RunsToMake(options);
  CheckThatSizesWillBeKnown(names, options);
  std::vector<SurfaceRunResult> runs = RunAll(names, options);
  AddDerivedFigures(runs);

  std::printf("\n");
  PrintRuns(runs);
  const TextRows targets = TargetRows(runs);
  const SurfaceRunResult* us = FindRun(runs, "us-1");
  if (us)
  {
    std::printf("\nBy level (edges and delta in voxels of level 0, distances in those of the "
                "level):\n\n");
    PrintLevels(us->Figures);
    if (options.Profile)
    {
      std::printf("\nBy phase (seconds of the clock, us-1):\n\n");
      PrintProfile(us->Figures);
    }
  }
  std::printf("\nTargets (Q: the worst level of us-1):\n\n");
  PrintTable(targets, 2);

  if (!options.Csv.empty())
  {
    WriteCsv(options.Csv, RunRows(runs));
    WriteCsv(CsvNameOf(options.Csv, "levels"), LevelRows(us ? us->Figures : RunFigures()));
    WriteCsv(CsvNameOf(options.Csv, "targets"), targets);
  }
  return std::all_of(runs.begin(), runs.end(),
           [](const SurfaceRunResult& run) { return run.Figures.GetText("Failure").empty(); })
    ? 0
    : 1;
}

/** Loads the volume once, for what can be wrong with it to be told once. */
void Introduce(const SurfaceBenchmarkOptions& options)
{
  BenchmarkedVolume volume;
  try
  {
    SurfaceBenchmarkOptions asItIs = options;
    asItIs.ResampleTo = 0;
    volume = LoadVolume(asItIs);
  }
  catch (const std::exception& error)
  {
    throw UsageError(error.what());
  }
  double range[2];
  volume.Image->GetScalarRange(range);
  if (!(volume.IsoValue > range[0] && volume.IsoValue < range[1]))
  {
    throw UsageError("the iso-value " + ShortText(volume.IsoValue, 6) +
      " is not between the least and the largest voxel, " + ShortText(range[0], 6) + " and " +
      ShortText(range[1], 6));
  }
  const int* size = volume.Image->GetDimensions();
  std::printf("%s: %d x %d x %d voxels, %s, %s to %s, iso-value %s\n",
    (options.Scene.empty() ? options.Volume : options.Scene).c_str(), size[0], size[1], size[2],
    volume.Image->GetScalarTypeAsString(), ShortText(range[0], 6).c_str(),
    ShortText(range[1], 6).c_str(), ShortText(volume.IsoValue, 6).c_str());
  std::fflush(stdout);
}

int Main(int argc, char** argv)
{
  const SurfaceBenchmarkOptions options = ParseSurfaceOptions(argc, argv);
  if (options.Help)
  {
    std::cout << SurfaceUsage();
    return 0;
  }
  if (!options.Run.empty())
  {
    return RunHere(options);
  }
  Introduce(options);
  if (options.Growth)
  {
    return MeasureGrowth(options) ? 0 : 1;
  }
  if (options.Model)
  {
    return MeasureModel(options) ? 0 : 1;
  }
  if (!options.Threads.empty())
  {
    return MeasureThreads(options) ? 0 : 1;
  }
  return options.Peaks ? (MeasurePeaks(options) ? 0 : 1) : RunSideBySide(options);
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    return Main(argc, argv);
  }
  catch (const UsageError& error)
  {
    std::cerr << "BenchmarkSurface: " << error.what() << "\nTry --help." << std::endl;
    return 2;
  }
  catch (const std::exception& error)
  {
    std::cerr << "BenchmarkSurface: " << error.what() << std::endl;
    return 1;
  }
}
