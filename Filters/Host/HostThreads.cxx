// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/HostThreads.h"

#include <vtkSMPTools.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <future>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

namespace volumic
{
namespace
{
/** Create threads until the system denies one (`ulimit -u`, a cgroup). Return their number. */
std::size_t CreateThreads(std::size_t most)
{
  std::vector<std::future<void>> threads;
  threads.reserve(most);
  try
  {
    std::promise<void> end; // Its destructor ends the threads.
    const std::shared_future<void> hasEnded(end.get_future());
    std::generate_n(std::back_inserter(threads), most,
      [&] { return std::async(std::launch::async, [hasEnded] { hasEnded.wait(); }); });
  }
  catch (const std::exception&)
  {
  }
  return threads.size();
}

/**
 * Return the most threads that the system allows: oneTBB ends the process if it cannot create one.
 * The limit holds for all users of oneTBB, until the process ends. One thread is a reserve.
 */
int MostThreads()
{
  static const auto processors = static_cast<std::size_t>(NumberOfProcessors());
  static const std::size_t most = std::max<std::size_t>(CreateThreads(processors), 1);
  [[maybe_unused]] static const auto* const limit = most < processors
    ? new tbb::global_control(tbb::global_control::max_allowed_parallelism, most)
    : nullptr;
  return static_cast<int>(most);
}

int NumberOf(int requested)
{
  int number = NumberOfProcessors();
  std::vector<int> limits = { requested };
  if (requested <= 0)
  {
    const char* maximum = std::getenv("VTK_SMP_MAX_THREADS");
    // The sequential backend always reports one thread, which is not a choice of the host.
    const bool isSequential = std::string(vtkSMPTools::GetBackend()) == "Sequential";
    limits = { QuotaOfProcessors(), maximum ? std::atoi(maximum) : 0,
      isSequential ? 0 : vtkSMPTools::GetEstimatedNumberOfThreads() };
  }
  for (const int limit : limits)
  {
    number = limit > 0 ? std::min(number, limit) : number;
  }
  return number > 1 ? std::min(number, MostThreads()) : 1;
}

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

HostThreads::HostThreads(int numberOfThreads) : Executor(NumberOf(numberOfThreads)) {}

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
  std::string number, controllers, group;
  while (std::getline(groups, number, ':') && std::getline(groups, controllers, ':') &&
    std::getline(groups, group))
  {
    const std::string mount =
      root + (controllers.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/cpu");
    const bool isOfCpu =
      controllers.empty() || ("," + controllers + ",").find(",cpu,") != std::string::npos;
    // The quota of a group limits its subgroups. In a container its own group is the outermost.
    for (std::size_t end = isOfCpu ? group.size() : std::string::npos; end != std::string::npos;
         end = group.rfind('/'))
    {
      group.resize(end);
      const int quota = QuotaOfFolder(mount + group);
      least = quota > 0 && (least == 0 || quota < least) ? quota : least;
    }
  }
  return least;
}
}
