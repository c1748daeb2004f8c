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
 * Return whether this is the first process of a parallel run, or the only one. It computes the
 * whole output. Some filters (vtkCleanPolyData) request piece 0 of 0 in the other processes.
 */
inline bool IsFirstProcess(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* info = RequestedOutput(request, outputs);
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  return info->Get(Pipeline::UPDATE_PIECE_NUMBER()) <= 0 &&
    !(info->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
      info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == 0);
}

inline bool IsOnlyProcess(vtkInformation* request, vtkInformationVector* outputs)
{
  return RequestedOutput(request, outputs)
           ->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) <= 1;
}

/** Return whether the data come from Resample To Image, where all must request the same extent. */
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
 * Implement RequestUpdateExtent(). The first process requests the whole of all inputs. The others
 * request empty images, unless these are resampled, and their piece of surfaces, which are small.
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

/** Make named null blocks. ParaView's views and writers need the same blocks in all processes. */
inline void MakeNullBlocks(vtkMultiBlockDataSet* output, const std::vector<std::string>& names)
{
  output->SetNumberOfBlocks(static_cast<unsigned int>(names.size()));
  for (unsigned int block = 0; block < output->GetNumberOfBlocks(); ++block)
  {
    output->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), names[block].c_str());
  }
}

/** Return whether the input data of a port are released after use. */
inline bool AreReleased(vtkAlgorithm* filter, int port)
{
  bool areReleased = vtkDataObject::GetGlobalReleaseDataFlag() != 0;
  for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
  {
    areReleased |= filter->GetExecutive()->GetInputInformation(port, i)->Get(
                     vtkDemandDrivenPipeline::RELEASE_DATA()) != 0;
  }
  return areReleased;
}

// The next two functions depend on the version of VTK: 9.1, 9.2 (ParaView 5.11) and newer.

/**
 * Return whether the filter must stop. In newer versions of VTK other filters can abort it, too.
 * Test the filter's own flag first: the executive clears the outputs if CheckAbort() returns true.
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
 * Reset AbortExecute, which VTK does not do from 9.2 on. A request from before a run must not stop
 * it, and a request that stopped it must not stop the filters downstream.
 */
inline void ForgetAbort(vtkAlgorithm* algorithm)
{
  algorithm->SetAbortExecute(0);
}
}

#endif
