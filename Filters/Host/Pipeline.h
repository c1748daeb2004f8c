// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPipeline_h
#define volumicPipeline_h

#include <vtkAlgorithm.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkVersion.h>
#include <vtkVersionMacros.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace volumic
{
/** Return the information of the requested output, with the piece of the update request. */
inline vtkInformation* RequestedOutput(vtkInformation* request, vtkInformationVector* outputs)
{
  return outputs->GetInformationObject(std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT())));
}

/**
 * Return whether this is the first process of a parallel run, or the only one. It makes the whole
 * output, and the outputs of all others are empty. Some filters (vtkCleanPolyData) request piece 0
 * of 0 in the other processes.
 */
inline bool IsFirstProcess(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* info = RequestedOutput(request, outputs);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool isOfNone = info->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
    info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == 0;
  return !isOfNone && info->Get(Pipeline::UPDATE_PIECE_NUMBER()) <= 0;
}

/** Return whether the run is not parallel. */
inline bool IsOnlyProcess(vtkInformation* request, vtkInformationVector* outputs)
{
  return RequestedOutput(request, outputs)
           ->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) <= 1;
}

/**
 * Return whether data come from Resample To Image. Its processes share the work: it ends them all
 * unless they request the same extent.
 */
inline bool IsResampled(vtkAlgorithm* source)
{
  bool isResampled = source->IsA("vtkResampleToImage") != 0;
  for (int port = 0; port < source->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < source->GetNumberOfInputConnections(port); ++i)
    {
      isResampled = isResampled || IsResampled(source->GetInputAlgorithm(port, i));
    }
  }
  return isResampled;
}

/**
 * RequestUpdateExtent of the filters: the first process requests the whole of all inputs. The
 * others request no voxels of images, unless these are resampled. Of data without a whole extent,
 * such as surfaces, they request the piece of their own number, which is small.
 * @param all whether all processes request the whole
 */
inline void RequestInputs(vtkAlgorithm* filter, vtkInformation* request,
  vtkInformationVector** inputs, vtkInformationVector* outputs, bool all = false)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool isFirst = all || IsFirstProcess(request, outputs);
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = inputs[port]->GetInformationObject(i);
      const bool hasExtent = info->Has(Pipeline::WHOLE_EXTENT()) != 0;
      if (hasExtent)
      {
        std::array<int, 6> extent = { 0, -1, 0, -1, 0, -1 };
        const bool isWhole = isFirst || IsResampled(filter->GetInputAlgorithm(port, i));
        isWhole ? info->Get(Pipeline::WHOLE_EXTENT(), extent.data()) : void();
        info->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
      }
      if (isFirst || hasExtent)
      {
        info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
        info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
        info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
      }
    }
  }
}

/**
 * Make null blocks of these names. ParaView's views and writers need the same blocks in all
 * processes.
 */
inline void MakeNullBlocks(vtkMultiBlockDataSet* output, const std::vector<std::string>& names)
{
  output->SetNumberOfBlocks(static_cast<unsigned int>(names.size()));
  for (unsigned int block = 0; block < output->GetNumberOfBlocks(); ++block)
  {
    output->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), names[block].c_str());
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

// What differs between VTK 9.1, ParaView 5.11's VTK 9.2 and newer ones.

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
