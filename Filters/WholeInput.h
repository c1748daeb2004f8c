// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef WholeInput_h
#define WholeInput_h

#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

namespace volumic
{
/// Asks an input for all that it has, not for the piece that a process of a parallel run would get:
/// levels and surfaces depend on the whole image.
inline void AskForWholeInput(vtkInformation* info)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (info->Has(Pipeline::WHOLE_EXTENT()))
  {
    int extent[6];
    info->Get(Pipeline::WHOLE_EXTENT(), extent);
    info->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
  }
  info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
}
}

#endif
