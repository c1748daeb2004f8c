// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeToSurface.h"

#include "AlgorithmErrors.h"
#include "CellVoxels.h"
#include "Core/Common/Refuse.h"
#include "InputImage.h"
#include "PrefixErrors.h"
#include "SegmentationVolume.h"
#include "vtkImagePyramid.h"
#include "vtkOtsuThreshold.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>

#include <cmath>
#include <string>

vtkStandardNewMacro(vtkVolumeToSurface);

//------------------------------------------------------------------------------
vtkVolumeToSurface::vtkVolumeToSurface()
{
  vtkNew<vtkImagePyramid> defaults;
  this->NumberOfLevels = defaults->GetNumberOfLevels();
  this->MinimumLevelSize = defaults->GetMinimumLevelSize();
  this->ReductionFactor = defaults->GetReductionFactor();
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
    vtkNew<vtkOtsuThreshold> otsu;
    otsu->SetInputData(voxels.Image);
    otsu->SetInputArrayToProcess(0, voxels.Selection);
    otsu->SetSelectedComponent(volume.Settings.SelectedComponent);
    const std::string errors = volumic::UpdateAndCollectErrors(otsu);
    if (!errors.empty())
    {
      volumic::Refuse("Iso Value is not set, and can't be found: ", errors);
    }
    volume.Settings.Options.IsoValue = otsu->GetThreshold();
  }
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetNumberOfLevels(this->NumberOfLevels);
  pyramid->SetMinimumLevelSize(this->MinimumLevelSize);
  pyramid->SetReductionFactor(this->ReductionFactor);
  this->MakeLevels(pyramid, voxels.Image, volume);
  return volume;
}

//------------------------------------------------------------------------------
void vtkVolumeToSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << endl;
  os << indent << "MinimumLevelSize: " << this->MinimumLevelSize << endl;
  os << indent << "ReductionFactor: " << this->ReductionFactor << endl;
}
