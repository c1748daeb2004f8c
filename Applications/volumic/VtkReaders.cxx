// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VtkReaders.h"

#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageReader2.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>

#include <algorithm>

namespace tool
{
vtkSmartPointer<vtkImageData> ImageOf(
  vtkAlgorithm* reader, const std::string& name, bool hasTrustedWarnings)
{
  VtkMessages messages;
  messages.UpdateReader(reader, name, hasTrustedWarnings);
  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  if (!image)
  {
    throw Failure(name + ": holds no image");
  }
  return image;
}

VolumePlacement PlacementOf(vtkMatrix4x4* matrix, const double* spacing)
{
  VolumePlacement placement;
  std::array<Vector3, 3> steps;
  for (int row = 0; row < 3; ++row)
  {
    placement.Origin[row] = matrix->GetElement(row, 3);
    for (int axis = 0; axis < 3; ++axis)
    {
      steps[axis][row] = matrix->GetElement(row, axis) * spacing[axis];
    }
  }
  placement.SetSteps(steps);
  return placement;
}

ReaderSlabs::ReaderSlabs(const std::string& name, const Factory& make) : Name(name), Make(make)
{
  const vtkSmartPointer<vtkImageReader2> reader = make();
  VtkMessages messages;
  messages.ListenTo(reader);
  messages.Catch([&] { reader->UpdateInformation(); });
  if (!messages.Errors.empty())
  {
    throw Failure(name + ": cannot be read (" + messages.JoinedErrors() + ")");
  }
  const int* extent = reader->GetDataExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Size[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1;
  }
  this->Type = reader->GetDataScalarType();
  this->Components = reader->GetNumberOfScalarComponents();
  std::copy_n(reader->GetDataSpacing(), 3, this->Placement.Spacing.begin());
  std::copy_n(reader->GetDataOrigin(), 3, this->Placement.Origin.begin());
}

vtkSmartPointer<vtkDataArray> ReaderSlabs::Read(int first, int count)
{
  const vtkSmartPointer<vtkImageReader2> reader = this->Make();
  const int extent[6] = { 0, this->Size[0] - 1, 0, this->Size[1] - 1, first, first + count - 1 };
  VtkMessages messages;
  messages.UpdateReader(reader, this->Name, this->HasTrustedWarnings, extent);
  vtkSmartPointer<vtkDataArray> values = reader->GetOutput()->GetPointData()->GetScalars();
  if (!values)
  {
    throw Failure(this->Name + ": holds no voxels");
  }
  return this->Slope == 1.0 && this->Shift == 0.0 ? values
                                                  : Rescaled(values, this->Slope, this->Shift);
}
}
