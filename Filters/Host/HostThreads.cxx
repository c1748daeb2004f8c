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
  const auto limit = [&number](int maximum)
  { number = maximum > 0 ? std::min(number, maximum) : number; };
  limit(QuotaOfProcessors());
  const char* maximum = std::getenv("VTK_SMP_MAX_THREADS");
  limit(maximum ? std::atoi(maximum) : 0);
  // The sequential backend always reports one thread, which is not a choice of the host.
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
/** Return the quota of a group, or 0 for none ("max" and -1). */
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
  std::array<cpu_set_t, 16> set; // One set has room for 1024 processors.
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
  // Lines are "0::/a/b" (version 2) or "4:cpu,cpuacct:/a/b" (version 1).
  std::string number;
  std::string controllers;
  std::string group;
  while (std::getline(groups, number, ':') && std::getline(groups, controllers, ':') &&
    std::getline(groups, group))
  {
    const bool isVersion2 = controllers.empty();
    if (!isVersion2 && ("," + controllers + ",").find(",cpu,") == std::string::npos)
    {
      continue;
    }
    const std::string mount = root + (isVersion2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/cpu");
    // The quota of a group limits its subgroups. In a container its own group is the outermost.
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
