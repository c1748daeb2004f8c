// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FullDisk.h"

#include "ToolErrors.h"

#include <csignal>

#include <unistd.h>

namespace tool
{
namespace
{
/** What the handler writes, which may not make a text itself. Never freed: it may be called late. */
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
    "the room that was reserved. Make room, choose another one with --scratch, or raise --memory\n");
  struct sigaction action = {};
  action.sa_sigaction = EndWithWords;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}
}
