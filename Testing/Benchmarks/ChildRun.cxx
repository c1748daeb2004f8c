// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "ChildRun.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace volumic
{
namespace bench
{
namespace
{

std::string OwnProgram()
{
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  if (length <= 0 || length == static_cast<ssize_t>(sizeof path))
  {
    throw std::runtime_error("can't find this program's own file");
  }
  return std::string(path, static_cast<std::size_t>(length));
}

std::string ReadAll(int descriptor)
{
  std::string text;
  char buffer[4096];
  for (;;)
  {
    const ssize_t count = read(descriptor, buffer, sizeof buffer);
    if (count > 0)
    {
      text.append(buffer, static_cast<std::size_t>(count));
    }
    else if (count == 0 || errno != EINTR)
    {
      return text;
    }
  }
}

std::string Ending(int status)
{
  if (WIFSIGNALED(status))
  {
    return std::string("killed: ") + strsignal(WTERMSIG(status));
  }
  return WEXITSTATUS(status) == 0 ? "" : "exit code " + std::to_string(WEXITSTATUS(status));
}

} // namespace

void EndWithParent()
{
  prctl(PR_SET_PDEATHSIG, SIGTERM);
}

RunFigures RunAsChild(const std::vector<std::string>& arguments)
{
  const std::string program = OwnProgram();
  std::vector<char*> argv(1, const_cast<char*>(program.c_str()));
  for (const std::string& argument : arguments)
  {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);

  int ends[2];
  if (pipe(ends) != 0)
  {
    throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0)
  {
    close(ends[0]);
    throw std::runtime_error("can't start " + program + ": " + std::strerror(error));
  }
  std::istringstream written(ReadAll(ends[0]));
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {
  }

  RunFigures figures;
  figures.Read(written);
  const std::string ending = Ending(status);
  if (!ending.empty() && figures.GetText("Failure").empty()) // else it has told why itself
  {
    figures.SetText("Failure", ending);
  }
  return figures;
}

} // namespace bench
} // namespace volumic
