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
#include <filesystem>
#include <iostream>
#include <new>

namespace
{
using namespace tool;

ExitCode Run(const ToolOptions& options, Ranks& ranks)
{
  vtkNew<vtkImagePyramid> pyramid;
  vtkSmartPointer<vtkDeformableSurface> filter = vtkSmartPointer<vtkDeformableSurface>::New();
  // Both decide on the levels of the pyramid.
  if (options.HasProperty("EdgeLength") || options.HasProperty("UpperValue"))
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
    case ToolOptions::Task::ListSeries:
      for (const std::string& series : ListSeries(options.Volume))
      {
        std::cout << series << "\n";
      }
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
  ApplyProperties(options, filters);
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
    return options.Labels.empty() ? SegmentVolume(options, filters)
                                  : SegmentLabels(options, filters, ranks);
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(options.Volume + ": not enough memory; crop it, or resample it to fewer voxels");
  }
}

/** What the command line asks for. */
int RunAndTell(int argc, char* argv[], Ranks& ranks)
{
  ExitCode code = RuntimeFailure;
  std::string words;
  try
  {
    ToolOptions options = ParseOptions(argc, argv);
    options.Ranks = ranks.Count();
    const ExitCode ended = Run(options, ranks);
    FailIf(!std::cout.flush(), "the standard output cannot be written; is its disk full?");
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
  catch (const std::filesystem::filesystem_error& error)
  {
    words = PlainName(error.path1().string()) + ": " + error.code().message();
  }
  catch (const std::exception& error)
  {
    // It may tell of what a damaged file holds, be that a megabyte.
    words = PlainName(Shortened(error.what(), 1500));
  }
  std::cerr << "volumic: " << words << "\n";
  return code;
}

/** At the other ranks. */
int WaitForFirst(int argc, char* argv[], Ranks& ranks)
{
  vtkNew<vtkImagePyramid> pyramid;
  vtkNew<vtkDeformableSurface> filter;
  vtkNew<vtkLabelsToSurfaces> labels;
  const FilterTrio filters{ pyramid, filter, labels };
  ToolOptions options;
  try
  {
    options = ParseOptions(argc, argv);
    ApplyProperties(options, filters);
  }
  catch (const std::exception&)
  {
    // The first rank has the same words, and tells what is wrong with them.
  }
  CatchInterrupts();
  return HelpWithLabels(options, filters, ranks);
}
}

int main(int argc, char* argv[])
{
  // The threads are Volumic's own: VTK's would come on top of --threads, and may end the program
  // where the system denies them memory.
  vtkSMPTools::SetBackend("Sequential");
  Ranks ranks(argc, argv);
  ListenTo(ranks);
  if (!ranks.IsFirst())
  {
    return WaitForFirst(argc, argv, ranks);
  }
  const int code = RunAndTell(argc, argv, ranks);
  ranks.End(code);
  return code;
}
