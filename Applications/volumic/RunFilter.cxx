// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunFilter.h"

#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkNew.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

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

/** Columns of the terminal behind stderr. */
std::size_t TerminalWidth()
{
  winsize size{};
  const bool isKnown = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return isKnown ? size.ws_col : 80;
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
    const double share = std::clamp(filter->GetProgress(), 0.0, 1.0);
    const char* text = filter->GetProgressText();
    if (this->Style == ProgressStyle::OneLine)
    {
      this->Redraw(share, text ? text : "");
    }
    else if (this->Style == ProgressStyle::Lines && share >= this->NextShare)
    {
      std::fprintf(
        stderr, "%s: %3.0f %%  %s\n", this->Title.c_str(), 100.0 * share, text ? text : "");
      this->NextShare = share + 0.1;
    }
  }

  /** Clear the line. */
  void Finish()
  {
    if (this->IsDrawn)
    {
      std::fprintf(stderr, "\r%*s\r", static_cast<int>(TerminalWidth() - 1), "");
    }
  }

  std::string Title;
  ProgressStyle Style = ProgressStyle::None;

private:
  void Redraw(double share, const std::string& text)
  {
    const auto now = std::chrono::steady_clock::now();
    if (this->IsDrawn && now - this->DrawnAt < std::chrono::milliseconds(100))
    {
      return;
    }
    this->IsDrawn = true;
    this->DrawnAt = now;
    const std::size_t barWidth = 24;
    const auto filled = static_cast<std::size_t>(share * barWidth);
    char percent[16];
    std::snprintf(percent, sizeof(percent), "%3.0f %% ", 100.0 * share);
    std::string line = this->Title + " [" + std::string(filled, '#') +
      std::string(barWidth - filled, '.') + "] " + percent + text;
    line.resize(TerminalWidth() - 1, ' '); // a longer one would leave its rests
    std::fprintf(stderr, "\r%s", line.c_str());
    std::fflush(stderr);
  }

  bool IsDrawn = false;
  std::chrono::steady_clock::time_point DrawnAt;
  double NextShare = 0.0;
};
}

void CatchInterrupts()
{
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
}

bool WasInterrupted()
{
  return interrupted != 0;
}

FilterRun RunFilter(vtkAlgorithm* filter, const std::string& title, ProgressStyle style)
{
  VtkMessages messages;
  messages.ListenTo(filter);
  vtkNew<ProgressObserver> observer;
  observer->Title = title;
  observer->Style = style;
  filter->AddObserver(vtkCommand::ProgressEvent, observer);

  const auto started = std::chrono::steady_clock::now();
  filter->Update();
  FilterRun run;
  run.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  filter->RemoveObserver(observer);
  observer->Finish();
  run.Warnings = messages.Warnings;
  run.IsInterrupted = WasInterrupted();
  if (!messages.Errors.empty())
  {
    throw Failure(messages.Errors.front());
  }
  return run;
}
}
