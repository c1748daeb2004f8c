// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeToSurface.h"

#include "CellVoxels.h"
#include "Core/Common/Communicator.h"
#include "ImageVoxels.h"
#include "InputImage.h"
#include "LabelHint.h"
#include "OtsuThreshold.h"
#include "PrefixErrors.h"
#include "SegmentationVolume.h"
#include "vtkImagePyramid.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

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
  volumic::Communicator& ranks = this->Ranks();
  const vtkSmartPointer<vtkDataObject> read = this->ReadInput(input, true, volume);
  if (!read && ranks.NumberOfRanks() == 1)
  {
    return volume;
  }
  const volumic::PointVoxels voxels = volumic::TakeCellsAsPoints(
    volumic::PrefixErrors("Input port 0: ", [&] { return volumic::PieceOfImage(ranks, read); }),
    volume.Selection);
  volume.Selection = voxels.Selection;
  if (std::isnan(volume.Settings.Options.IsoValue))
  {
    volume.Settings.Options.IsoValue =
      volumic::PrefixErrors("Iso Value is not set, and can't be found: Input port 0: ",
        [&]
        {
          return volumic::FindOtsuThreshold(
            ranks, voxels.Image, voxels.Selection, volume.Settings.SelectedComponent);
        });
  }
  if (ranks.NumberOfRanks() == 1)
  {
    this->TellOfLabels(voxels.Image, voxels.Selection);
  }
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetNumberOfLevels(this->NumberOfLevels);
  pyramid->SetMinimumLevelSize(this->MinimumLevelSize);
  pyramid->SetReductionFactor(this->ReductionFactor);
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
