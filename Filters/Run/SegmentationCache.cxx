// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationCache.h"

#include "Host/Pipeline.h"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <utility>

namespace volumic
{
namespace
{
/**
 * What comes to a connection. ParaView puts a filter of its own between any two, which hands on the
 * same data in an object that it fills anew at each update.
 */
vtkDataObject* DataOf(vtkAlgorithmOutput* connection)
{
  vtkAlgorithm* producer = connection->GetProducer();
  while (producer->IsA("vtkPVPostFilter") && producer->GetNumberOfInputConnections(0) > 0)
  {
    connection = producer->GetInputConnection(0, 0);
    producer = connection->GetProducer();
  }
  return producer->GetOutputDataObject(connection->GetIndex());
}

/** When anything of it was changed last; blocks do not tell of it by themselves. */
vtkMTimeType TimeOf(vtkDataObject* data)
{
  vtkMTimeType time = data->GetMTime();
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      time = std::max(time, it->GetCurrentDataObject()->GetMTime());
    }
  }
  return time;
}
}

SegmentationCache::Inputs SegmentationCache::InputsOf(vtkAlgorithm* filter)
{
  Inputs inputs;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      vtkDataObject* data = DataOf(filter->GetInputConnection(port, i));
      inputs.emplace_back(data, data ? TimeOf(data) : 0);
    }
    inputs.emplace_back(nullptr, port);
  }
  return inputs;
}

bool SegmentationCache::MayKeep(vtkAlgorithm* filter)
{
  bool areReleased = filter->GetReleaseDataFlag() != 0;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    areReleased = areReleased || AreReleased(filter, port);
  }
  return !areReleased; // They must not stay because of us.
}

void SegmentationCache::Keep(std::unique_ptr<SurfaceSegmentation> run, vtkAlgorithm* filter)
{
  this->Drop();
  if (!MayKeep(filter))
  {
    return;
  }
  this->Time = filter->GetMTime();
  this->InputsOfRun = InputsOf(filter);
  if (!run->CanGoOn())
  {
    run->LetGo();
  }
  this->Kept = std::move(run);
}

void SegmentationCache::Drop()
{
  this->Kept.reset();
  this->InputsOfRun.clear();
  this->Time = 0;
}

std::unique_ptr<SurfaceSegmentation> SegmentationCache::TakeRun()
{
  std::unique_ptr<SurfaceSegmentation> run = std::move(this->Kept);
  this->Drop();
  return run;
}

void SegmentationCache::IgnoreChange(vtkMTimeType before, vtkMTimeType after)
{
  if (this->Time != 0 && this->Time == before)
  {
    this->Time = after;
  }
}

bool SegmentationCache::IsValidFor(vtkAlgorithm* filter) const
{
  return this->Time != 0 && this->Time == filter->GetMTime() &&
    this->InputsOfRun == InputsOf(filter);
}
}
