// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LoadVolume.h"

#include "Announcer.h"
#include "ParseNumbers.h"
#include "ReadVolume.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "VolumeImage.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <array>
#include <string>

namespace tool
{
vtkSmartPointer<vtkImageData> LoadVolume(
  const ToolOptions& options, int component, const Announcer& announcer)
{
  const vtkSmartPointer<vtkImageData> image = ReadVolume(options.Volume);
  try
  {
    ChooseScalars(image, options.Array);
  }
  catch (const Failure& failure)
  {
    throw Failure(options.Volume + ": " + failure.what());
  }
  if (options.Spacing)
  {
    image->SetSpacing(options.Spacing->data());
  }
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  const auto times = [](auto a, auto b, auto c)
  { return NumberText(a) + " x " + NumberText(b) + " x " + NumberText(c); };
  const std::array<double, 2> range = RangeOf(scalars, component);
  const int components = scalars->GetNumberOfComponents();
  const std::string taken = components == 1
    ? ""
    : (component < 0 ? "magnitude" : "component " + NumberText(component)) + " of " +
      NumberText(components) + " components (--component), ";
  announcer.Say(options.Volume + ": " + times(size[0], size[1], size[2]) + " voxels of " +
    times(spacing[0], spacing[1], spacing[2]) + ", " + scalars->GetDataTypeAsString() + ", " +
    taken + NumberText(range[0]) + " to " + NumberText(range[1]));
  return image;
}
}
