// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHostThreads_h
#define volumicHostThreads_h

#include "Core/Common/Executor.h"
#include "vtkFiltersVolumicModule.h" // for the export macro

#include <string>

namespace volumic
{
/** The threads of a filter: as many as the host program and the machine allow. */
class VTKFILTERSVOLUMIC_EXPORT HostThreads final : public Executor
{
public:
  /**
   * @param numberOfThreads upper limit. The affinity of the process is a further limit. 0: all
   *        processors of the affinity, limited by VTK_SMP_MAX_THREADS, by the number that the host
   *        has given to vtkSMPTools and by the quota of the process's cgroup.
   */
  explicit HostThreads(int numberOfThreads);
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
