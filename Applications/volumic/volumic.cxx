// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// From a volume to a closed surface: the program `volumic`. See volumic.1, or
//   volumic --help
#include "LabelNames.h"
#include "Ranks.h"
#include "ReadVolume.h"
#include "RunFilter.h"
#include "Segment.h"
#include "SurfaceProperties.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkImagePyramid.h>
#include <vtkLabelsToSurfaces.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkVersion.h>
#include <vtkVolumeToSurface.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

namespace
{
using namespace tool;

/** All ranks have the same words to go by. */
void CheckThatWordsAgree(int argc, char* argv[], Ranks& ranks)
{
  std::vector<std::string> words = { "volumic " VOLUMIC_VERSION };
  words.insert(words.end(), argv + std::min(argc, 1), argv + argc);
  ranks.NeedSame(words,
    [](const std::string& here, const std::string& first)
    {
      const auto named = [](const std::string& word)
      { return word.empty() ? "nothing more" : "'" + word + "'"; };
      throw UsageError("has " + named(here) + " where the first rank has " + named(first) +
        "; start all with the same command line");
    });
}

ExitCode Run(const ToolOptions& options, Ranks& ranks)
{
  if (options.Task != ToolOptions::Task::Segment && !ranks.IsFirst())
  {
    return Success;
  }
  vtkNew<vtkImagePyramid> pyramid;
  vtkSmartPointer<vtkDeformableSurface> filter = vtkSmartPointer<vtkDeformableSurface>::New();
  if (options.HasProperty("EdgeLength"))
  {
    filter = vtkSmartPointer<vtkVolumeToSurface>::New();
  }
  vtkNew<vtkLabelsToSurfaces> labels;
  const FilterTrio filters{ pyramid, filter, labels };
  switch (options.Task)
  {
    case ToolOptions::Task::ShowHelp:
      PrintHelp(std::cout, filters);
      return Success;
    case ToolOptions::Task::ShowVersion:
      std::cout << "volumic " VOLUMIC_VERSION " (VTK " << vtkVersion::GetVTKVersion() << ")\n";
      return Success;
    case ToolOptions::Task::ListProperties:
      PrintProperties(std::cout, filters);
      return Success;
    case ToolOptions::Task::ListFiles:
      for (const std::string& file : FilesOfVolume(options.Volume))
      {
        std::cout << file << "\n";
      }
      return Success;
    case ToolOptions::Task::Segment:
      break;
  }
  ranks.Together([&] { ApplyProperties(options, filters); });
  if (filter->GetMemoryLimit() > 0)
  {
    TellOfFullDisk(filter->GetScratchDirectory());
  }
  if (const int most = std::max(filter->GetNumberOfThreads(), labels->GetNumberOfThreads()))
  {
    // Also for what has no such property, as vtkOtsuThreshold.
    setenv("VTK_SMP_MAX_THREADS", std::to_string(most).c_str(), 1);
  }
  try
  {
    return options.Labels.empty() ? SegmentVolume(options, filters, ranks)
                                  : SegmentLabels(options, filters, ranks);
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(options.Volume + ": not enough memory; crop it, or resample it to fewer voxels");
  }
}

/** What the command line asks for, by all ranks; only the first one says something. */
int RunAndTell(int argc, char* argv[], Ranks& ranks)
{
  ExitCode code = RuntimeFailure;
  std::string words;
  try
  {
    ToolOptions options;
    ranks.Together([&] { options = ParseOptions(argc, argv); });
    CheckThatWordsAgree(argc, argv, ranks);
    options.Quiet = options.Quiet || !ranks.IsFirst();
    const ExitCode ended = Run(options, ranks);
    ranks.OnFirst(
      []
      {
        FailIf(!std::cout.flush(), "the standard output cannot be written; is its disk full?");
      });
    return ended;
  }
  catch (const UsageError& error)
  {
    words = std::string(error.what()) + "\nTry 'volumic --help'.";
    code = UsageFailure;
  }
  catch (const std::bad_alloc&)
  {
    words = "not enough memory";
  }
  catch (const std::exception& error)
  {
    // It may tell of what a damaged file holds, be that a megabyte.
    words = PlainName(Shortened(error.what(), 1500));
  }
  const bool isOfAll = ranks.HaveAgreed();
  if (ranks.IsFirst() || !isOfAll)
  {
    std::cerr << "volumic: " << words << "\n";
  }
  if (!isOfAll)
  {
    ranks.Abort(code);
  }
  return code;
}
}

int main(int argc, char* argv[])
{
  // The threads are Volumic's own: VTK's would come on top of --threads, and may end the program
  // where the system denies them memory.
  vtkSMPTools::SetBackend("Sequential");
  Ranks ranks(argc, argv);
  return RunAndTell(argc, argv, ranks);
}
