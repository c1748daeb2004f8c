// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentationCache.h"

#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>

namespace volumic
{
namespace
{
template <typename T>
void AddPart(T* part, std::vector<std::pair<const void*, vtkMTimeType>>& parts)
{
  parts.emplace_back(part, part ? part->GetMTime() : 0);
}
}

SegmentationCache::SegmentationCache() = default;
SegmentationCache::~SegmentationCache() = default;

void SegmentationCache::Add(vtkDataObject* data, Inputs& inputs)
{
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      inputs.Places.push_back(it->GetCurrentFlatIndex());
      Add(it->GetCurrentDataObject(), inputs);
    }
    return;
  }
  for (int type : { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::FIELD })
  {
    vtkFieldData* arrays = data->GetAttributesAsFieldData(type);
    for (int i = 0; arrays && i < arrays->GetNumberOfArrays(); ++i)
    {
      AddPart(arrays->GetAbstractArray(i), inputs.Parts);
    }
    auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
    AddPart(attributes ? attributes->GetScalars() : nullptr, inputs.Parts);
  }
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    std::vector<double>& places = inputs.Places;
    places.insert(places.end(), image->GetExtent(), image->GetExtent() + 6);
    places.insert(places.end(), image->GetSpacing(), image->GetSpacing() + 3);
    places.insert(places.end(), image->GetOrigin(), image->GetOrigin() + 3);
    const double* direction = image->GetDirectionMatrix()->GetData();
    places.insert(places.end(), direction, direction + 9);
  }
  else if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    AddPart(surface->GetPoints(), inputs.Parts);
    for (vtkCellArray* cells :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      // Where there are none, each call may give another object.
      AddPart(cells && cells->GetNumberOfCells() > 0 ? cells : nullptr, inputs.Parts);
    }
  }
  else
  {
    AddPart(data, inputs.Parts);
  }
}

SegmentationCache::Inputs SegmentationCache::Describe(vtkInformationVector** input, int ports)
{
  Inputs inputs;
  for (int port = 0; port < ports; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      if (vtkDataObject* data = vtkDataObject::GetData(input[port], i))
      {
        Add(data, inputs);
      }
    }
    inputs.Places.push_back(port);
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
  this->Given = Inputs();
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
