// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Segment.h"

#include "LabelMap.h"
#include "LoadInputs.h"
#include "ProbeVolumes.h"
#include "Report.h"
#include "RunFilter.h"
#include "SurfaceFacts.h"
#include "SurfaceProperties.h"
#include "Texts.h"
#include "ToolOptions.h"
#include "WriteOutputs.h"
#include "WriteResults.h"

#include <vtkCommand.h>
#include <vtkDeformableSurface.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkNew.h>
#include <vtkOtsuThreshold.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkVolumeToSurface.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <utility>

namespace tool
{
namespace
{
/** What a run works on and with. */
struct Job
{
  const ToolOptions& Options;
  vtkImagePyramid* Pyramid;
  vtkDeformableSurface* Filter;
  const Announcer Says;
  LoadedVolume Volume;
};

/** Of too little memory is said for which volume, and what helps. */
std::string NamedReason(const ToolOptions& options, const std::string& text)
{
  return text.find("memory") == std::string::npos
    ? text
    : options.Volume + ": not enough memory to segment it; " +
      "a coarser level (--finest 1), or the volume cropped or resampled, needs less";
}

FilterRun RunOnVolume(
  const Job& job, vtkAlgorithm* filter, const std::string& title, ProgressStyle style)
{
  try
  {
    return RunFilter(filter, title, style);
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(NamedReason(job.Options, "memory"));
  }
  catch (const Failure& error)
  {
    throw Failure(NamedReason(job.Options, error.what()));
  }
}

/**
 * Gives the surface's filter its levels: a pyramid that is run here, or, where the length of the
 * edges or a range of values decides on the pyramid, the volume.
 * @return the run of the pyramid, if there was one.
 */
FilterRun GiveLevels(const Job& job)
{
  vtkImagePyramid* pyramid = job.Pyramid;
  vtkDeformableSurface* filter = job.Filter;
  if (auto* whole = vtkVolumeToSurface::SafeDownCast(filter))
  {
    whole->SetNumberOfLevels(pyramid->GetNumberOfLevels());
    whole->SetMinimumLevelSize(pyramid->GetMinimumLevelSize());
    whole->SetReductionFactor(pyramid->GetReductionFactor());
    whole->SetInputData(job.Volume.Image);
    return FilterRun();
  }
  ShareWithPyramid(filter, pyramid);
  pyramid->SetInputData(job.Volume.Image);
  // The surface lets go of each level as it leaves it.
  pyramid->ReleaseDataFlagOn();
  const FilterRun run = RunOnVolume(job, pyramid, "Building the pyramid", job.Says.Style);
  FailIf(run.IsInterrupted, "interrupted before there was a surface; nothing is written");
  filter->SetInputConnection(pyramid->GetOutputPort());
  return run;
}

/** Says, as soon as it is known, where a run with --resume goes on from. */
class ResumeTeller
{
public:
  explicit ResumeTeller(const Job& job)
    : Filter(job.Filter), Says(job.Says),
      Observer(job.Filter->AddObserver(vtkCommand::ProgressEvent, this, &ResumeTeller::Follow))
  {
  }
  ~ResumeTeller() { this->Filter->RemoveObserver(this->Observer); }

  void Tell()
  {
    if (this->Filter->GetResume() && !std::exchange(this->HasTold, true))
    {
      const int level = this->Filter->GetResumedLevel();
      this->Says.Say(level >= -1
          ? "going on from level " + std::to_string(level) + ", to which a run before has come"
          : "there is no checkpoint to resume from: the run begins anew");
    }
  }

private:
  void Follow()
  {
    const char* text = this->Filter->GetProgressText();
    if (text && std::strncmp(text, "Level", 5) == 0)
    {
      this->Tell();
    }
  }

  vtkDeformableSurface* Filter;
  const Announcer& Says;
  unsigned long Observer;
  bool HasTold = false;
};

/** One that was stopped on its way may go on. */
void RemoveCheckpointOfEnded(const Job& job, const std::string& reason)
{
  if (reason != "cancelled" && reason != "time limit")
  {
    job.Filter->RemoveCheckpoint();
  }
}

/** The value that the options don't tell. */
void TakeOtsuThreshold(const Job& job)
{
  vtkNew<vtkOtsuThreshold> otsu;
  otsu->SetInputData(job.Volume.Image);
  otsu->SetSelectedComponent(job.Filter->GetSelectedComponent());
  RunOnVolume(job, otsu, "Otsu's threshold", ProgressStyle::None);
  job.Filter->SetIsoValue(otsu->GetThreshold());
  const double least = job.Volume.Facts.Range[0];
  const bool hasPadding = least < -1024.0 && otsu->GetHistogram()->GetValue(0) > least;
  job.Says.Say("iso-value " + NumberText(job.Filter->GetIsoValue()) +
    ", a guess by Otsu's threshold" +
    (hasPadding ? ", for which voxels of " + NumberText(least) + " are padding" : "") +
    "; choose another one with --iso");
}

/** To whoever searches an isopotential in a label map. vtkVolumeToSurface says so itself. */
void TellOfLabels(const Job& job)
{
  const std::string hint = vtkVolumeToSurface::SafeDownCast(job.Filter)
    ? std::string()
    : vtkVolumeToSurface::HintAtLabels(job.Volume.Image);
  if (!hint.empty())
  {
    job.Says.Say("warning: " + job.Options.Volume + ": " + hint + " (--labels all)");
  }
}

/** Where the image is ... */
std::string PlaceOfObject(const Job& job)
{
  const bool isBright = job.Filter->GetObjectIsBright();
  const std::string iso = NumberText(job.Filter->GetIsoValue());
  return job.Options.HasProperty("UpperValue") ? (isBright ? "between " : "not between ") + iso +
      " and " + NumberText(job.Filter->GetUpperValue())
                                               : (isBright ? "above " : "below ") + iso;
}

/** Run the filter of the surface, for --triangles with several tolerances. */
FilterRun FindTriangles(const Job& job)
{
  const auto run = [&job]
  { return RunOnVolume(job, job.Filter, "Evolving the surface", job.Says.Style); };
  FilterRun last = run();
  const double wanted = job.Options.Triangles;
  constexpr double near = 1.1;
  constexpr int tries = 12;
  const Vector3& spacing = job.Volume.Facts.Spacing;
  const double unit = *std::min_element(spacing.begin(), spacing.end());
  // Tolerances with too many triangles, and with too few, with the counts.
  std::pair<double, double> fine = { 0.0, 0.0 };
  std::pair<double, double> coarse = { 0.0, 0.0 };
  double seconds = last.Seconds;
  for (int i = 1; wanted > 0.0 && !last.IsInterrupted; ++i)
  {
    const double tolerance = job.Filter->GetTolerance();
    const auto count = static_cast<double>(job.Filter->GetOutput()->GetNumberOfPolys());
    job.Says.Say("tolerance " + NumberText(tolerance) + ": " + NumberText(count) + " triangles");
    if (count <= 0.0 || (count < near * wanted && count * near > wanted))
    {
      break;
    }
    const bool isStuck =
      tolerance > fine.first && count > wanted && count > 0.98 * fine.second && fine.second > 0.0;
    if ((tolerance == 0.0 && count < wanted) || isStuck || i == tries)
    {
      last.Warnings.push_back((tolerance == 0.0 ? "without a tolerance it has no more than "
                                                : "no tolerance was found; this one leaves ") +
        NumberText(count) + " triangles; --edge-length makes others");
      break;
    }
    (count > wanted ? fine : coarse) = { tolerance, count };
    const double next = tolerance == 0.0 ? 0.2 * unit
      : coarse.second == 0.0             ? 2.0 * tolerance
      : fine.first == 0.0                ? 0.5 * tolerance
                                         : fine.first *
        std::pow(coarse.first / fine.first,
          std::clamp(
            std::log(fine.second / wanted) / std::log(fine.second / coarse.second), 0.1, 0.9));
    const double digits = std::pow(10.0, std::floor(std::log10(next)) - 3.0);
    job.Filter->SetTolerance(digits * std::round(next / digits));
    last = run();
    seconds += last.Seconds;
  }
  last.Seconds = seconds;
  return last;
}

/** Run the filters. @param results given their times and warnings */
void FindSurface(const Job& job, ReportInput& results)
{
  CatchInterrupts();
  job.Filter->LeaveCheckpoints(); // Until all is written.
  const FilterRun pyramidRun = GiveLevels(job);
  ResumeTeller teller(job);
  const FilterRun run = FindTriangles(job);
  teller.Tell();
  for (const FilterRun& each : { pyramidRun, run })
  {
    for (const std::string& warning : each.Warnings)
    {
      job.Says.Say("warning: " + warning);
    }
  }
  results.StopReason = StopReason(job.Filter->GetOutput());
  results.PyramidSeconds = pyramidRun.Seconds;
  results.SurfaceSeconds = run.Seconds;
  results.Warnings = run.Warnings;
  results.Size = SizeOf(job.Filter->GetOutput());
  results.IsFinished = results.StopReason == "converged" || results.StopReason == "limit cycle";
  if (results.Size.Triangles > 0)
  {
    return;
  }
  RemoveCheckpointOfEnded(job, results.StopReason);
  const bool isLate = results.StopReason == "time limit";
  throw Failure(isLate    ? "the time limit came before there was a surface; nothing is written"
      : run.IsInterrupted ? "interrupted before there was a surface; nothing is written"
                          : "the surface vanished: is the object where the image is " +
        PlaceOfObject(job) + "? (--iso, --upper, --dark)");
}
}

ExitCode SegmentVolume(const ToolOptions& options, const FilterTrio& filters)
{
  vtkDeformableSurface* filter = filters.Surface;
  Job job = { options, filters.Pyramid, filter, Announcer(options), LoadedVolume() };
  CheckFiles(options);
  const vtkNew<vtkImagePyramid> holder; // of the scratch memory of the volume
  job.Volume = LoadVolume(options, filter, holder, job.Says);
  ReportInput results;
  results.ReaderMemory = PeakMemory();
  const int component = filter->GetSelectedComponent();
  if (filter->GetMemoryLimit() > 0)
  {
    filter->SetSelectedComponent(-1); // The volume has no other.
  }
  if (!options.WrittenVolume.empty())
  {
    NameLabels(options, job.Volume.Image, job.Says);
    WriteVolume(job.Volume.Image, options.WrittenVolume, job.Says.Style);
  }
  if (!options.WantsSurface())
  {
    return Success;
  }
  const ProbeVolumes probes(options, job.Says);
  TellOfLabels(job);
  SetStart(options, filter);
  const vtkNew<vtkImagePyramid> edgesHolder;
  SetEdges(options, job.Volume.Image, filter, edgesHolder, job.Says);
  if (!options.HasProperty("IsoValue") && !options.HasProperty("UpperValue"))
  {
    TakeOtsuThreshold(job);
  }
  if (!options.HasProperty("SnapshotInterval") && !options.Snapshots.empty())
  {
    filter->SetSnapshotInterval(10);
  }
  FindSurface(job, results);
  filter->SetSelectedComponent(component); // as it was chosen
  results.VolumeName = std::filesystem::path(options.Volume).filename().string();
  results.Volume = job.Volume.Facts;
  results.Filters = filters;
  std::vector<std::string> warnings;
  results.Surface = WithEnds(filter->GetOutput(), job.Volume.Image, options.Ends, warnings);
  for (const std::string& warning : warnings)
  {
    job.Says.Say("warning: " + options.Volume + ": " + warning);
    results.Warnings.push_back(warning);
  }
  probes.AddTo(results.Surface);
  job.Says.Follow("", [&] { WriteOutputs(options, results, job.Says.Style); });
  RemoveCheckpointOfEnded(job, results.StopReason);

  job.Says.Say(std::to_string(results.Size.Vertices) + " vertices after " +
    std::to_string(filter->GetHistory()->GetNumberOfRows()) + " iterations: " + results.StopReason);
  job.Says.Say(TextOfPrint(options, { results.Surface }, results.Volume.World));
  if (results.Filling.Grid)
  {
    job.Says.Say(TextOf(results.Filling));
  }
  if (!results.IsFinished)
  {
    const bool canGoOn = !filter->GetCheckpointFolder().empty();
    std::cerr << "volumic: unfinished (" << results.StopReason
              << "); the surface as it is was written"
              << (canGoOn ? "; the same command with --resume goes on" : "") << "\n";
  }
  return results.IsFinished ? Success : Unfinished;
}
}
