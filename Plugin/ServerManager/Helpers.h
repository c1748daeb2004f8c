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
 * Create a filter of the group internal_filters at the location of its producer, with the producer
 * as input. Return null if there is no filter of that name.
 */
vtkSmartPointer<vtkSMSourceProxy> NewHelper(
  const char* name, vtkSMSourceProxy* producer, unsigned int port);

/** Update the helper at the time of the data, so that its producer does not run again. */
void RunHelper(vtkSMSourceProxy* helper, vtkPVDataInformation* data);
}

#endif
