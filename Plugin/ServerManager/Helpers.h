// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHelpers_h
#define volumicHelpers_h

#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

class vtkPVDataInformation;

namespace volumic
{
/**
 * A filter of ours that tells of data, of the group internal_filters: where its producer is, and
 * after it. Null: there is none.
 */
vtkSmartPointer<vtkSMSourceProxy> NewHelper(
  const char* name, vtkSMSourceProxy* producer, unsigned int port);

/** At the time that is shown, so that nothing before the helper has to run again. */
void RunHelper(vtkSMSourceProxy* helper, vtkPVDataInformation* data);
}

#endif
