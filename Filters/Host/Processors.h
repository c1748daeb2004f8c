// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProcessors_h
#define volumicProcessors_h

#include "vtkFiltersVolumicModule.h" // for the export macro

#include <string>

namespace volumic
{
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
