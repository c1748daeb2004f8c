// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHostThreads_h
#define volumicHostThreads_h

#include "Core/Common/Executor.h"
#include "vtkFiltersVolumicModule.h" // for the export macro

#include <functional>
#include <memory>
#include <string>

namespace volumic
{
/**
 * The threads of a filter, for the core: its own, as many as the host program and the machine mean
 * it to have. VTK's (vtkSMPTools) are left alone: those of VTK 9.1 forget how many they should be,
 * end the program where the system denies them one, or are none, as in Debian's ParaView.
 */
class VTKFILTERSVOLUMIC_EXPORT HostThreads final : public Executor
{
public:
  /**
   * @param numberOfThreads at most, no more than there are processors to run on (affinity). 0 = as
   *        many as these, where none of the following says fewer: VTK_SMP_MAX_THREADS, the number
   *        that the host has given to vtkSMPTools, the quota of the process's cgroup.
   */
  explicit HostThreads(int numberOfThreads);

  /** How many work within Run(), the calling one included. */
  int NumberOfThreads() const { return this->Number; }

  /**
   * For tests: what For() is to do within Run() goes to this executor; null, as at first: to the
   * threads. Not while a filter runs.
   */
  static void UseInstead(Executor* executor);

  /** Runs `work`, within which there are the threads that For() may use. May be within another. */
  void Run(const std::function<void()>& work);

  /** @see Executor. Outside Run() everything is done on the calling thread. */
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body) override;

private:
  int Number;
  std::unique_ptr<Executor> Threads; ///< Within Run().
};

/** Those that the process may run on (its affinity); at least one. */
VTKFILTERSVOLUMIC_EXPORT int NumberOfProcessors();

/**
 * How many processors' time the groups of a process may take together (Linux's cgroups, of version
 * 2 and 1, by which containers and batch systems share machines out), rounded up; 0: as much as
 * there is.
 * @param root of the file system, for tests
 */
VTKFILTERSVOLUMIC_EXPORT int QuotaOfProcessors(const std::string& root = "");
}

#endif
