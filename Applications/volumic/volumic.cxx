// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// From a volume to a closed surface: the program `volumic`. See volumic.1, or
//   volumic --help
#include "InputFiles.h"
#include "Ranks.h"
#include "SegmentLabels.h"
#include "SegmentVolume.h"
#include "SurfaceProperties.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkImagePyramid.h>
#include <vtkLabelsToSurfaces.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkVersion.h>
#include <vtkVolumeToSurface.h>

#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <utility>

namespace
{
using namespace tool;

ExitCode Run(const ToolOptions& options, Ranks& ranks)
{
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
  try
  {
    return options.Labels.empty() ? SegmentVolume(options, filters, ranks)
                                  : SegmentLabels(options, filters, ranks);
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(options.Volume + ": not enough memory; crop it, or resample it to fewer voxels");
  }
  catch (const std::exception& error)
  {
    // By its words only TBB, which VTK's threads may be of, tells that it gets no memory for one.
    if (std::string(error.what()).find("pthread_create") == std::string::npos)
    {
      throw;
    }
    throw Failure(options.Volume +
      ": not enough memory to segment it: no thread can be started; "
      "crop it, or resample it to fewer voxels");
  }
}

/** What the options ask for, by all ranks; only the first one says something. */
int RunAndTell(ToolOptions options, Ranks& ranks)
{
  options.Quiet = options.Quiet || !ranks.IsFirst();
  ExitCode code = RuntimeFailure;
  std::string words;
  try
  {
    const ExitCode ended = Run(options, ranks);
    ranks.OnFirst(
      []
      {
        if (!std::cout.flush())
        {
          throw Failure("the standard output cannot be written; is its disk full?");
        }
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
    words = error.what();
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
  // Under a limit of memory VTK's own threads of the standard library end the program; Volumic's
  // don't.
  if (vtkSMPTools::GetBackend() == std::string("STDThread"))
  {
    vtkSMPTools::SetBackend("Sequential");
  }
  ToolOptions options;
  try
  {
    options = ParseOptions(argc, argv);
  }
  catch (const UsageError& error)
  {
    if (Ranks::IsFirstByEnvironment())
    {
      std::cerr << "volumic: " << error.what() << "\nTry 'volumic --help'.\n";
    }
    return UsageFailure;
  }
  const bool worksTogether = options.Task == ToolOptions::Task::Segment;
  if (!worksTogether && !Ranks::IsFirstByEnvironment())
  {
    return Success;
  }
  Ranks ranks(argc, argv, worksTogether);
  return RunAndTell(std::move(options), ranks);
}
