// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LoadVolume.h"

#include "Announcer.h"
#include "ParseNumbers.h"
#include "ReadVolume.h"
#include "RunFilter.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "VolumeImage.h"
#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <array>
#include <string>

namespace tool
{
namespace
{
/** Level 0 of the holder's pyramid: all slabs of the source, one behind the other. */
vtkSmartPointer<vtkImageData> GatherSlabs(
  const std::string& name, vtkAlgorithm* source, vtkImagePyramid* holder, ProgressStyle style)
{
  VtkMessages messages;
  messages.ListenTo(source);
  std::string failure;
  bool isInterrupted = false;
  messages.Catch(
    [&]
    {
      try
      {
        isInterrupted = RunFilter(holder, "Reading the volume", style).IsInterrupted;
      }
      catch (const Failure& error)
      {
        failure = error.what();
      }
    });
  // What a reader warns of are data that it lacked and made up.
  messages.Errors.insert(
    messages.Errors.end(), messages.Warnings.begin(), messages.Warnings.end());
  if (!messages.Errors.empty())
  {
    throw Failure(name + ": cannot be read (" + messages.JoinedErrors() + ")");
  }
  if (!failure.empty())
  {
    throw Failure(name + ": " + failure);
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  auto* level = vtkImageData::SafeDownCast(holder->GetOutput()->GetBlock(0));
  if (!level)
  {
    throw Failure(isInterrupted ? "interrupted before there was a surface; nothing is written"
                                : name + ": holds no image");
  }
  image->ShallowCopy(level);
  vtkNew<vtkFieldData> fields; // A copy of its own, without those of a level.
  fields->ShallowCopy(level->GetFieldData());
  fields->RemoveArray("Level");
  fields->RemoveArray("Unit");
  image->SetFieldData(fields);
  return image;
}
}

vtkSmartPointer<vtkImageData> LoadVoxels(const std::string& name, const std::string& array,
  vtkDeformableSurface* filter, vtkImagePyramid* holder, const Announcer& announcer)
{
  vtkSmartPointer<vtkImageData> image;
  if (filter->GetMemoryLimit() == 0)
  {
    image = ReadVolume(name);
  }
  else
  {
    const OpenedVolume opened = OpenVolume(name, array, filter->GetScratchDirectory());
    if (!opened.Whole.empty())
    {
      announcer.Say("warning: " + name + ": volumes of this kind (" + opened.Whole +
        ") are read as a whole, whatever --memory says; it is kept from then on");
    }
    opened.Source->ReleaseDataFlagOn();
    holder->SetInputConnection(opened.Source->GetOutputPort());
    if (!array.empty())
    {
      holder->SetInputArrayToProcess(
        0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array.c_str());
    }
    holder->SetNumberOfLevels(1);
    holder->SetSelectedComponent(filter->GetSelectedComponent());
    holder->SetNaNIsBackground(filter->GetNaNIsBackground());
    holder->SetNumberOfThreads(filter->GetNumberOfThreads());
    holder->SetMemoryLimit(filter->GetMemoryLimit());
    holder->SetScratchDirectory(filter->GetScratchDirectory());
    image = GatherSlabs(name, opened.Source, holder, announcer.Style);
    holder->RemoveAllInputs();
  }
  try
  {
    ChooseScalars(image, array);
  }
  catch (const Failure& failure)
  {
    throw Failure(name + ": " + failure.what());
  }
  return image;
}

vtkSmartPointer<vtkImageData> LoadVolume(const ToolOptions& options, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  const int component = filter->GetSelectedComponent();
  const vtkSmartPointer<vtkImageData> image =
    LoadVoxels(options.Volume, options.Array, filter, holder, announcer);
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
