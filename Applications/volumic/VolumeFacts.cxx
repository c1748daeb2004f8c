// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeFacts.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>

namespace tool
{
vtkInformation* VoxelsIn(vtkInformation* info, const std::string& array)
{
  constexpr int points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  return array.empty()
    ? vtkDataObject::GetActiveFieldInformation(info, points, vtkDataSetAttributes::SCALARS)
    : vtkDataObject::GetNamedFieldInformation(info, points, array.c_str());
}

int ComponentsIn(vtkInformation* voxels)
{
  const bool isCounted = voxels && voxels->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
  return isCounted ? voxels->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) : 1;
}

std::array<int, 3> VolumeFacts::Size() const
{
  const auto& e = this->Extent;
  return { e[1] - e[0] + 1, e[3] - e[2] + 1, e[5] - e[4] + 1 };
}

VolumeFacts FactsOf(vtkImageData* image, vtkDataArray* scalars, int component)
{
  VolumeFacts facts;
  image->GetExtent(facts.Extent.data());
  image->GetSpacing(facts.Spacing.data());
  image->GetOrigin(facts.Origin.data());
  facts.Resampling = GetFact(image, "Resampling");
  facts.Type = scalars->GetDataType();
  facts.Components = scalars->GetNumberOfComponents();
  facts.Range = RangeOf(scalars, component);
  return facts;
}
}
