// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicWholeInput_h
#define volumicWholeInput_h

#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>

namespace volumic
{
/**
 * Asks an input for all that it has, not for the piece that a process of a parallel run would get:
 * levels and surfaces depend on the whole image.
 */
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

/**
 * Asks an image for none of its voxels: a process that makes nothing of them must not hold them.
 * Data in pieces keeps the piece that the process would get, which is small and its own.
 */
inline void AskForNothing(vtkInformation* info)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (info->Has(Pipeline::WHOLE_EXTENT()))
  {
    const int none[6] = { 0, -1, 0, -1, 0, -1 };
    info->Set(Pipeline::UPDATE_EXTENT(), none, 6);
    // In one piece: a part of nothing is nonsense where a source can produce sub-extents.
    info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
    info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
    info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  }
}

/**
 * Whether this is the first process of a parallel run, or the only one. It makes the whole
 * output; the others have none, as they would only repeat it. Some filters (vtkCleanPolyData) have
 * the others ask for one of no pieces.
 */
inline bool IsFirstProcess(vtkInformation* request, vtkInformationVector* output)
{
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* info = output->GetInformationObject(port);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool isOfNone = info->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
    info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == 0;
  return !isOfNone && info->Get(Pipeline::UPDATE_PIECE_NUMBER()) <= 0;
}

/** How many layers beyond a piece someone asks for, of an output. */
inline int GhostLevelsAskedOf(vtkInformation* request, vtkInformationVector* output)
{
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  return output->GetInformationObject(port)->Get(
    vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS());
}

/**
 * RequestUpdateExtent of a filter whose processes work together: each asks for its piece. Sources
 * that cannot give pieces give the first process all.
 */
inline void AskForPieces(
  vtkInformation* request, vtkInformationVector** input, int ports, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const int outputPort = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* asked = output->GetInformationObject(outputPort);
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = input[port]->GetInformationObject(i);
      if (info->Has(Pipeline::WHOLE_EXTENT()))
      {
        int extent[6];
        info->Get(Pipeline::WHOLE_EXTENT(), extent);
        info->Set(Pipeline::UPDATE_EXTENT(), extent, 6);
      }
      info->CopyEntry(asked, Pipeline::UPDATE_PIECE_NUMBER());
      info->CopyEntry(asked, Pipeline::UPDATE_NUMBER_OF_PIECES());
      info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
}

/**
 * RequestUpdateExtent of a filter whose first process makes the whole output from all of its
 * inputs: the others ask for no image.
 */
inline void AskForWholeInputs(
  vtkInformation* request, vtkInformationVector** input, int ports, vtkInformationVector* output)
{
  const bool isFirst = IsFirstProcess(request, output);
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = input[port]->GetInformationObject(i);
      isFirst ? AskForWholeInput(info) : AskForNothing(info);
    }
  }
}

/** Whether the data that come to a port are released once they have been used. */
inline bool AreReleased(vtkAlgorithm* filter, int port)
{
  for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
  {
    vtkInformation* info = filter->GetExecutive()->GetInputInformation(port, i);
    if (info->Get(vtkDemandDrivenPipeline::RELEASE_DATA()))
    {
      return true;
    }
  }
  return vtkDataObject::GetGlobalReleaseDataFlag() != 0;
}
}

#endif
