// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/HostThreads.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#ifdef __linux__
#include <sched.h>
#endif

namespace volumic
{
namespace
{
int NumberOf(int requested)
{
  int number = NumberOfProcessors();
  if (requested > 0)
  {
    return std::min(number, requested);
  }
  const auto limit = [&number](int most) { number = most > 0 ? std::min(number, most) : number; };
  limit(QuotaOfProcessors());
  const char* most = std::getenv("VTK_SMP_MAX_THREADS");
  limit(most ? std::atoi(most) : 0);
  // One thread is what is left of VTK, not what the host wants.
  if (std::string(vtkSMPTools::GetBackend()) != "Sequential")
  {
    limit(vtkSMPTools::GetEstimatedNumberOfThreads());
  }
  return number;
}
}

HostThreads::HostThreads(int numberOfThreads) : Executor(NumberOf(numberOfThreads)) {}

namespace
{
/** Of one group; 0: it has none. "max" and -1, which stand for no limit, are no numbers above 0. */
int QuotaOfFolder(const std::string& folder)
{
  double quota = 0.;
  double period = 0.;
  if (std::ifstream file(folder + "/cpu.max"); !(file >> quota >> period))
  {
    std::ifstream(folder + "/cpu.cfs_quota_us") >> quota;
    std::ifstream(folder + "/cpu.cfs_period_us") >> period;
  }
  return quota > 0. && period > 0. ? static_cast<int>(std::min(std::ceil(quota / period), 1e6)) : 0;
}
}

int NumberOfProcessors()
{
#ifdef __linux__
  std::array<cpu_set_t, 16> set; // One may be too small for a machine's processors.
  if (sched_getaffinity(0, sizeof(set), set.data()) == 0)
  {
    return std::max(CPU_COUNT_S(sizeof(set), set.data()), 1);
  }
#endif
  return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
}

int QuotaOfProcessors(const std::string& root)
{
  int least = 0;
  std::ifstream groups(root + "/proc/self/cgroup");
  // As "0::/a/b" (version 2) or "4:cpu,cpuacct:/a/b".
  std::string number;
  std::string controllers;
  std::string group;
  while (std::getline(groups, number, ':') && std::getline(groups, controllers, ':') &&
    std::getline(groups, group))
  {
    const bool isOfAll = controllers.empty();
    if (!isOfAll && ("," + controllers + ",").find(",cpu,") == std::string::npos)
    {
      continue;
    }
    const std::string mount = root + (isOfAll ? "/sys/fs/cgroup" : "/sys/fs/cgroup/cpu");
    // What a group may take holds for those within it. In a container its own is the outermost one.
    while (true)
    {
      const int quota = QuotaOfFolder(mount + group);
      least = quota > 0 && (least == 0 || quota < least) ? quota : least;
      if (group.find('/') == std::string::npos)
      {
        break;
      }
      group.erase(group.rfind('/'));
    }
  }
  return least;
}
}
