// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentationCache.h"

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkSmartPointer.h>

#include <algorithm>

namespace volumic
{
namespace
{
/// When anything of it was changed last; blocks do not tell of it by themselves.
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

SegmentationCache::SegmentationCache() = default;
SegmentationCache::~SegmentationCache() = default;

SegmentationCache::Inputs SegmentationCache::Describe(vtkInformationVector** input, int ports)
{
  Inputs inputs;
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkDataObject* data = vtkDataObject::GetData(input[port], i);
      inputs.emplace_back(data, data ? TimeOf(data) : 0);
    }
    inputs.emplace_back(nullptr, port);
  }
  return inputs;
}

void SegmentationCache::Keep(std::unique_ptr<SurfaceSegmentation> run, vtkMTimeType time,
  vtkInformationVector** input, int ports)
{
  this->Drop();
  // What is released after its use must not stay because of us.
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      if (input[port]->GetInformationObject(i)->Get(vtkDemandDrivenPipeline::RELEASE_DATA()) ||
        vtkDataObject::GetGlobalReleaseDataFlag())
      {
        return;
      }
    }
  }
  this->Time = time;
  this->Given = Describe(input, ports);
  this->EndIsPlanned = run->GetSettings().EdgeLength != 0.0;
  this->PlannedEnd = run->GetSettings().FinestLevel;
  this->Recovery = run->GetSettings().Options.RecoverLostParts;
  if (run->CanGoOn())
  {
    this->Run = std::move(run);
  }
  else
  {
    this->Results = std::make_unique<SegmentationResults>(run->Results());
  }
}

void SegmentationCache::Drop()
{
  this->Run.reset();
  this->Results.reset();
  this->Given.clear();
  this->Time = 0;
}

void SegmentationCache::Allow(vtkMTimeType before, vtkMTimeType after)
{
  if (this->Time != 0 && this->Time == before)
  {
    this->Time = after;
  }
}

bool SegmentationCache::Serves(vtkMTimeType time, vtkInformationVector** input, int ports) const
{
  return this->Time != 0 && this->Time == time && this->Given == Describe(input, ports);
}

int SegmentationCache::EndOf(const SegmentationRequest& request) const
{
  const SegmentationResults& results = this->Run ? this->Run->Results() : *this->Results;
  const int finest = this->EndIsPlanned ? this->PlannedEnd : request.FinestLevel;
  return request.Preview ? std::max(finest, results.LevelOfPreview()) : finest;
}

const SegmentationResults* SegmentationCache::ResultsFor(const SegmentationRequest& request) const
{
  const SegmentationResults& results = this->Run ? this->Run->Results() : *this->Results;
  return results.HasAtRest(this->EndOf(request)) ? &results : nullptr;
}

std::unique_ptr<SurfaceSegmentation> SegmentationCache::TakeRun()
{
  return std::move(this->Run);
}
}
