// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The number of threads.
#include "Host/HostThreads.h"
#include "TemporaryFolder.h"
#include "TestPrelude.h"

#include <vtkSMPTools.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include <sys/resource.h>
#include <unistd.h>

using namespace volumic;

namespace
{
/** Return the number of threads that work at the same time. */
std::size_t ThreadsAtWork(int numberOfThreads)
{
  std::mutex mutex;
  std::set<std::thread::id> ids;
  HostThreads threads(numberOfThreads);
  const auto expected = static_cast<std::size_t>(threads.NumberOfThreads());
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const auto work = [&](std::size_t, std::size_t)
  {
    std::unique_lock<std::mutex> lock(mutex);
    ids.insert(std::this_thread::get_id());
    while (ids.size() < expected && std::chrono::steady_clock::now() < end)
    {
      lock.unlock();
      std::this_thread::yield();
      lock.lock();
    }
  };
  threads.For(200, 1, work);
  return ids.size();
}
}

TEST(HostThreads, AreIndependentOfTheVtkBackend)
{
  if (NumberOfProcessors() < 2 || std::getenv("VTK_SMP_MAX_THREADS"))
  {
    GTEST_SKIP() << "one processor, or a setting";
  }
  const std::string host = vtkSMPTools::GetBackend();
  for (const char* backend : { "Sequential", "STDThread", "TBB" })
  {
    if (!vtkSMPTools::SetBackend(backend))
    {
      continue; // Not in this build of VTK.
    }
    SCOPED_TRACE(backend);
    EXPECT_EQ(ThreadsAtWork(1), 1u);
    EXPECT_EQ(ThreadsAtWork(2), 2u);
    EXPECT_EQ(ThreadsAtWork(2), 2u) << "again";
    EXPECT_EQ(HostThreads(1 << 20).NumberOfThreads(), NumberOfProcessors());
    const int all = HostThreads(0).NumberOfThreads();
    EXPECT_EQ(ThreadsAtWork(0), static_cast<std::size_t>(all));
    setenv("VTK_SMP_MAX_THREADS", "1", 1);
    EXPECT_EQ(ThreadsAtWork(0), 1u);
    EXPECT_EQ(ThreadsAtWork(2), 2u) << "an explicit number takes precedence";
    unsetenv("VTK_SMP_MAX_THREADS");
    EXPECT_EQ(std::string(vtkSMPTools::GetBackend()), backend) << "VTK is left as it is";
  }
  vtkSMPTools::SetBackend(host.c_str());
}

TEST(HostThreads, AreLimitedByVtk)
{
  if (std::string(vtkSMPTools::GetBackend()) == "Sequential")
  {
    GTEST_SKIP() << "VTK has no number";
  }
  const int before = vtkSMPTools::GetEstimatedNumberOfThreads();
  vtkSMPTools::Initialize(1);
  EXPECT_EQ(HostThreads(0).NumberOfThreads(), 1);
  vtkSMPTools::Initialize(before);
}

TEST(HostThreadsDeathTest, AreAsManyAsTheSystemAllows)
{
  const auto work = []
  {
    // A user without other processes; root has no limit. LeakSanitizer starts a thread at exit.
    const rlimit most = { 1, 1 };
    const bool isLimited =
      (geteuid() != 0 || setuid(54321) == 0) && setrlimit(RLIMIT_NPROC, &most) == 0;
    std::_Exit(isLimited && ThreadsAtWork(2) == 1 && ThreadsAtWork(0) == 1 ? 0 : 1);
  };
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(work(), testing::ExitedWithCode(0), "");
}

TEST(Processors, AreLimitedByTheCgroupQuota)
{
  const TemporaryFolder root;
  const auto write = [&root](const std::string& name, const std::string& text)
  {
    const std::filesystem::path file = root.Path() + name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  };
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 0) << "no groups";
  write("/proc/self/cgroup", "12:memory:/m\n4:cpu,cpuacct:/a/b\n1:name=systemd:/a\n0::/c/d\n");
  write("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  write("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  write("/sys/fs/cgroup/c/d/cpu.max", "max 100000\n");
  write("/sys/fs/cgroup/cpu.max", "0 0\n");
  write("/sys/fs/cgroup/memory/m/cpu.cfs_quota_us", "100000\n");
  write("/sys/fs/cgroup/memory/m/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 0) << "no limits";
  write("/sys/fs/cgroup/c/cpu.max", "650000 100000\n");
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 7) << "of what a group is in; rounded up";
  write("/sys/fs/cgroup/c/d/cpu.max", "250000 50000\n");
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 5) << "of its own";
  write("/sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "300000\n");
  write("/sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 3) << "version 1";
  write("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "40000\n");
  EXPECT_EQ(QuotaOfProcessors(root.Path()), 1) << "of the container";
}
