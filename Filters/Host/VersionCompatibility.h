// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVersionCompatibility_h
#define volumicVersionCompatibility_h

#include <vtkAlgorithm.h>
#include <vtkVersion.h>
#include <vtkVersionMacros.h>

/** What differs between VTK 9.1, ParaView 5.11's VTK 9.2 and newer ones. */
namespace volumic
{
/**
 * Has someone asked the filter to stop? Newer VTKs can also be asked through other filters. The
 * filter's own flag comes first: after CheckAbort() says yes, the executive empties the outputs.
 */
inline bool IsAbortRequested(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230000)
  return algorithm->GetAbortExecute() || algorithm->CheckAbort();
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}

/**
 * Takes back a request to stop: from VTK 9.2 on nobody else does. One that came before a run isn't
 * meant for it; and one that was obeyed would make filters behind this one stop as well, with
 * nothing.
 */
inline void ForgetAbort(vtkAlgorithm* algorithm)
{
  if (algorithm->GetAbortExecute())
  {
    algorithm->SetAbortExecute(0);
  }
}
}

#endif
