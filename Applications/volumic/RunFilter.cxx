// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunFilter.h"

#include "Ranks.h"
#include "SurfaceProperties.h"
#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkNew.h>

#include <chrono>
#include <csignal>
#include <functional>

namespace tool
{
namespace
{
volatile std::sig_atomic_t interrupted = 0;

void Interrupt(int signal)
{
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

/** Shows the progress and hands the interruption on. Filters report at least every iteration. */
class ProgressObserver : public vtkCommand
{
public:
  static ProgressObserver* New() { return new ProgressObserver; }

  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    auto* filter = static_cast<vtkAlgorithm*>(caller);
    if (interrupted)
    {
      filter->SetAbortExecute(1);
    }
    const char* text = filter->GetProgressText();
    this->Line->Show(filter->GetProgress(), text ? text : "");
  }

  ProgressLine* Line = nullptr;
};

FilterRun Run(vtkAlgorithm* filter, const std::string& title, ProgressStyle style,
  const std::function<void()>& update)
{
  VtkMessages messages;
  messages.ListenTo(filter);
  ProgressLine line(title, style);
  vtkNew<ProgressObserver> observer;
  observer->Line = &line;
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);

  const auto started = std::chrono::steady_clock::now();
  update();
  FilterRun run;
  run.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  filter->RemoveObserver(tag);
  for (const std::string& warning : messages.Warnings)
  {
    run.Warnings.push_back(InWordsOfOptions(warning));
  }
  run.IsInterrupted = WasInterrupted();
  if (!messages.Errors.empty())
  {
    throw Failure(InWordsOfOptions(messages.Errors.front()));
  }
  return run;
}
}

void CatchInterrupts(const Ranks& ranks)
{
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
  if (!ranks.IsOne())
  {
    std::signal(SIGUSR1, Interrupt);
  }
}

bool WasInterrupted()
{
  return interrupted != 0;
}

FilterRun RunFilter(vtkAlgorithm* filter, const std::string& title, ProgressStyle style)
{
  return Run(filter, title, style, [filter] { filter->Update(); });
}

FilterRun RunFilter(
  vtkAlgorithm* filter, const std::string& title, ProgressStyle style, const Ranks& ranks)
{
  return Run(filter, title, style, [filter, &ranks] { ranks.Update(filter); });
}
}
