// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VtkReaders.h"

#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace tool
{
vtkSmartPointer<vtkImageData> ImageOf(vtkAlgorithm* reader, const std::string& name)
{
  VtkMessages messages;
  messages.UpdateReader(reader, name);
  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  FailIf(!image, name + ": holds no image");
  return image;
}

vtkSmartPointer<vtkImageReader2> ReaderOf(const std::string& name)
{
  vtkSmartPointer<vtkImageReader2> reader;
  VtkMessages ignored; // Some of those that are asked complain of what they don't know.
  ignored.Catch(
    [&] { reader.TakeReference(vtkImageReader2Factory::CreateImageReader2(name.c_str())); });
  FailIf(!reader, name + ": not a format that VTK's readers know");
  reader->SetFileName(name.c_str());
  return reader;
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
  VtkMessages().AskReader(reader, name);
  const int* extent = reader->GetDataExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t size = std::int64_t(extent[2 * axis + 1]) - extent[2 * axis] + 1;
    FailIf(size < 1 || size > std::numeric_limits<int>::max(),
      name + ": its header is damaged: " + std::to_string(size) + " voxels along axis " +
        std::to_string(axis + 1));
    this->Size[axis] = static_cast<int>(size);
  }
  this->Type = reader->GetDataScalarType();
  this->Components = reader->GetNumberOfScalarComponents();
  std::copy_n(reader->GetDataSpacing(), 3, this->Placement.Spacing.begin());
  std::copy_n(reader->GetDataOrigin(), 3, this->Placement.Origin.begin());
}

vtkSmartPointer<vtkDataArray> ReaderSlabs::Read(int first, int count)
{
  const vtkSmartPointer<vtkImageReader2> reader = this->Make();
  const int begin = this->IsReversed ? this->Size[2] - first - count : first;
  const int extent[6] = { 0, this->Size[0] - 1, 0, this->Size[1] - 1, begin, begin + count - 1 };
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
