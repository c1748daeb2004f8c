// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeToSurface.h"

#include "Input/ValueHints.h"
#include "Settings/PropertyTable.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

vtkStandardNewMacro(vtkVolumeToSurface);

//------------------------------------------------------------------------------
vtkVolumeToSurface::vtkVolumeToSurface()
{
  this->Internals->Settings.OfImages = true;
}

vtkVolumeToSurface::~vtkVolumeToSurface() = default;

//------------------------------------------------------------------------------
#define VOLUMIC_PYRAMID_PROPERTIES(MADE) \
  MADE(NumberOfLevels, int)              \
  MADE(MinimumLevelSize, int)            \
  MADE(ReductionFactor, double)

#define VolumicPyramidSetting(name, type) \
  VOLUMIC_SET_AND_GET(                    \
    vtkVolumeToSurface, name, type, Internals->Settings.Pyramid.name, this->Modified())
VOLUMIC_PYRAMID_PROPERTIES(VolumicPyramidSetting)

//------------------------------------------------------------------------------
std::string vtkVolumeToSurface::HintAtLabels(vtkImageData* image)
{
  vtkDataArray* voxels = image ? image->GetPointData()->GetScalars() : nullptr;
  const bool isScalar =
    voxels && voxels->GetNumberOfComponents() == 1 && voxels->HasStandardMemoryLayout();
  return isScalar ? volumic::HintAtLabels(voxels, image->GetDimensions()) : std::string();
}

//------------------------------------------------------------------------------
void vtkVolumeToSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define VolumicPyramidPrint(name, type) \
  os << indent << #name ": " << this->Internals->Settings.Pyramid.name << endl;
  VOLUMIC_PYRAMID_PROPERTIES(VolumicPyramidPrint)
}
