// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeToSurface.h"

#include "Core/Image/PyramidGeometry.h"
#include "Host/PrefixErrors.h"
#include "Input/CellVoxels.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/LabelHint.h"
#include "Input/OtsuThreshold.h"
#include "Settings/SegmentationVolume.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <cmath>
#include <string>

vtkStandardNewMacro(vtkVolumeToSurface);

//------------------------------------------------------------------------------
vtkVolumeToSurface::vtkVolumeToSurface()
{
  const volumic::PyramidOptions defaults;
  this->NumberOfLevels = defaults.NumberOfLevels;
  this->MinimumLevelSize = defaults.MinimumLevelSize;
  this->ReductionFactor = defaults.ReductionFactor;
}

vtkVolumeToSurface::~vtkVolumeToSurface() = default;

//------------------------------------------------------------------------------
volumic::SegmentationVolume vtkVolumeToSurface::PrepareVolume(vtkDataObject* input)
{
  volumic::SegmentationVolume volume = this->VolumeAsSet();
  const vtkSmartPointer<vtkDataObject> read = this->ReadInput(input, true, volume);
  if (!read)
  {
    return volume;
  }
  const volumic::PointVoxels voxels = volumic::TakeCellsAsPoints(
    volumic::PrefixErrors("Input port 0: ", [&] { return volumic::ImageOf(read); }),
    volume.Selection);
  volume.Selection = voxels.Selection;
  if (std::isnan(volume.Settings.Options.IsoValue))
  {
    volume.Settings.Options.IsoValue =
      volumic::PrefixErrors("Iso Value is not set, and can't be found: Input port 0: ",
        [&]
        {
          return volumic::FindOtsuThreshold(voxels.Image, voxels.Selection,
            volume.Settings.SelectedComponent, volume.Settings.End.NumberOfThreads).Threshold;
        });
  }
  this->TellOfLabels(voxels.Image, voxels.Selection);
  volumic::PyramidOptions pyramid;
  pyramid.NumberOfLevels = this->NumberOfLevels;
  pyramid.MinimumLevelSize = this->MinimumLevelSize;
  pyramid.ReductionFactor = this->ReductionFactor;
  this->MakeLevels(pyramid, voxels.Image, volume);
  return volume;
}

//------------------------------------------------------------------------------
std::string vtkVolumeToSurface::HintAtLabels(vtkImageData* image)
{
  vtkDataArray* voxels = image ? image->GetPointData()->GetScalars() : nullptr;
  const bool isOne =
    voxels && voxels->GetNumberOfComponents() == 1 && voxels->HasStandardMemoryLayout();
  return isOne ? volumic::HintAtLabels(voxels, image->GetDimensions()) : std::string();
}

//------------------------------------------------------------------------------
void vtkVolumeToSurface::TellOfLabels(vtkImageData* image, vtkInformation* selection)
{
  vtkDataArray* voxels = volumic::PrefixErrors(
    "Input port 0: ", [&] { return volumic::ChooseArray(selection, image); });
  if (this->HasToldOfLabels || voxels->GetNumberOfComponents() != 1 ||
    !voxels->HasStandardMemoryLayout())
  {
    return;
  }
  const std::string hint = volumic::HintAtLabels(voxels, image->GetDimensions());
  this->HasToldOfLabels = !hint.empty();
  if (this->HasToldOfLabels)
  {
    this->Warn("Input port 0: " + hint);
  }
}

//------------------------------------------------------------------------------
void vtkVolumeToSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << endl;
  os << indent << "MinimumLevelSize: " << this->MinimumLevelSize << endl;
  os << indent << "ReductionFactor: " << this->ReductionFactor << endl;
}
