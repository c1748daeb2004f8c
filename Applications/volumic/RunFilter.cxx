// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunFilter.h"

#include "Ranks.h"
#include "SurfaceProperties.h"
#include "ToolErrors.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <chrono>
#include <csignal>

#include <unistd.h>

namespace tool
{
namespace
{
volatile std::sig_atomic_t interrupted = 0;

Ranks* all = nullptr; ///< null: nobody else is listened to

void Interrupt(int signal)
{
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

/** Shows the progress and hands the interruption on. Filters report at least every iteration. */
void FollowProgress(vtkObject* caller, unsigned long, void* line, void*)
{
  auto* filter = static_cast<vtkAlgorithm*>(caller);
  if (WasInterrupted())
  {
    filter->SetAbortExecute(1);
  }
  const char* text = filter->GetProgressText();
  static_cast<ProgressLine*>(line)->Show(filter->GetProgress(), text ? text : "");
}
}

FilterRun RunFilter(
  vtkAlgorithm* filter, const std::string& title, ProgressStyle style, Ranks* ranks)
{
  VtkMessages messages;
  messages.ListenTo(filter);
  ProgressLine line(title, style);
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&line);
  observer->SetCallback(FollowProgress);
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);

  const auto started = std::chrono::steady_clock::now();
  ranks ? ranks->Update(filter) : filter->Update();
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

void ListenTo(Ranks& ranks)
{
  all = &ranks;
}

void CatchInterrupts()
{
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
  if (all && all->Count() > 1)
  {
    std::signal(SIGUSR1, Interrupt);
  }
}

bool WasInterrupted()
{
  return interrupted != 0 || (all && all->AreInterrupted());
}

// ---- Full disks ---------------------------------------------------------------------------------

namespace
{
/** What the handler writes, which may not make a text itself. Never freed: it may be called late.
 */
const std::string* words = nullptr;

void EndWithWords(int, siginfo_t* info, void*)
{
  if (info->si_code != BUS_ADRERR) // a fault of the program or the machine
  {
    std::signal(SIGBUS, SIG_DFL);
    std::raise(SIGBUS);
    return;
  }
  static_cast<void>(!write(STDERR_FILENO, words->data(), words->size()));
  _exit(RuntimeFailure);
}
}

void TellOfFullDisk(const std::string& directory)
{
  words = new std::string("volumic: the scratch directory" +
    (directory.empty() ? std::string() : " " + directory) +
    " can't keep what was put there: its disk is full, or fails, and its file system had not kept "
    "the room that was reserved. Make room, choose another one with --scratch, or raise "
    "--memory\n");
  struct sigaction action = {};
  action.sa_sigaction = EndWithWords;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}
}
