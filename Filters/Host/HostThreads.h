// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHostThreads_h
#define volumicHostThreads_h

#include "Core/Common/Executor.h"
#include "vtkFiltersVolumicModule.h" // for the export macro

#include <string>

namespace volumic
{
/** The threads of a filter, as many as the host program and the machine allow. */
class VTKFILTERSVOLUMIC_EXPORT HostThreads final : public Executor
{
public:
  /**
   * @param numberOfThreads upper limit, besides the affinity of the process. 0: all processors of
   *   the affinity, limited by VTK_SMP_MAX_THREADS, by vtkSMPTools::Initialize() and by the quota
   *   of the process's cgroup. The first object creates threads to find how many the system allows
   */
  explicit HostThreads(int numberOfThreads);
};

/** Return the number of processors in the affinity of the process, at least 1. */
VTKFILTERSVOLUMIC_EXPORT int NumberOfProcessors();

/**
 * Return the processor quota of the process's cgroups (Linux, version 1 and 2), rounded up. Return
 * 0 if there is no quota. Containers and batch systems set it.
 * @param root root of the file system, for tests
 */
VTKFILTERSVOLUMIC_EXPORT int QuotaOfProcessors(const std::string& root = "");
}

#endif
