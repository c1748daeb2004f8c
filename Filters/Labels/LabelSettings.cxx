// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSettings.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Pyramid/ImageLevels.h"
#include "Settings/SegmentationSettings.h"

#include <vtkImageData.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** In smallest distances of voxels: signs are held a voxel and a half from boundaries. */
constexpr double MostTolerance = 1.0;

/**
 * The Gaussian is at least this share of the longest distance of voxels: stairs are as high as
 * voxels are long. A larger share makes parts bulge that are thin along other axes.
 */
constexpr double ShareOfLongest = 0.625;

/** For more than this many times Smoothing that share is enough: thick slices are few. */
constexpr double MostBeyondVoxel = 2.5;

void CheckNumber(const char* name, double value)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    ThrowInvalidArgument(name, " is ", value, "; it must be 0 (none) or more.");
  }
}

/** @throws std::invalid_argument naming the lengths that are possible */
void CheckEdgeLength(double length, vtkImageData* image)
{
  constexpr int enough = 1 << 12; // The size of the image does not matter.
  vtkNew<vtkImageData> frame;
  frame->SetDimensions(enough, enough, enough);
  frame->SetSpacing(image->GetSpacing());
  PyramidOptions pyramid;
  PlanEdgeLength(length, SurfaceOptions().SamplingRatio, frame, pyramid);
}
}

void LabelSettings::Check(vtkImageData* image) const
{
  CheckNumber("Smoothing", this->Smoothing);
  if (this->Smoothing > 10.0)
  {
    ThrowInvalidArgument("Smoothing is ", this->Smoothing, " voxels; it must be at most 10.");
  }
  const bool isOfSmoothing = this->VoxelTolerance == -1.0;
  if (!isOfSmoothing && !(this->VoxelTolerance >= 0.0 && this->VoxelTolerance <= MostTolerance))
  {
    ThrowInvalidArgument("Voxel Tolerance is ", this->VoxelTolerance,
      "; it must be from 0 (none) to ", MostTolerance, " voxels, or -1 (a quarter of Smoothing).");
  }
  if (this->BoxFaces < 0 || this->BoxFaces > 2)
  {
    ThrowInvalidArgument(
      "Box Faces is ", this->BoxFaces, "; it must be 0 (rounded), 1 (flat) or 2 (periodic).");
  }
  CheckNumber("Edge Length", this->EdgeLength);
  CheckGrading(this->Grading, this->EdgeLength);
  CheckNumber("Minimum Component Volume", this->MinimumComponentVolume);
  if (this->FinestLevel < -1)
  {
    ThrowInvalidArgument("Finest Level is ", this->FinestLevel, "; it must be -1 or more.");
  }
  if (this->Metric != 0 && this->Metric != 1)
  {
    ThrowInvalidArgument("Metric is ", this->Metric, "; it must be 0 (Voxels) or 1 (World).");
  }
  const auto keep = static_cast<KeepComponentsType>(this->KeepComponents);
  if (keep != KeepComponentsType::AllComponents && keep != KeepComponentsType::LargestComponent &&
    keep != KeepComponentsType::LargeComponents)
  {
    ThrowInvalidArgument("Keep Components is ", this->KeepComponents,
      "; for labels it must be 0 (all), 1 (the largest) or 3 (large ones).");
  }
  if (this->EdgeLength > 0.0)
  {
    CheckEdgeLength(this->EdgeLength, image);
  }
}

LabelFieldOptions LabelSettings::FieldOptions(const LabelMap& map) const
{
  const double longest = ShareOfLongest * *std::max_element(map.Spacing.begin(), map.Spacing.end());
  LabelFieldOptions options;
  options.Sigma = std::min(
    this->Smoothing * std::max(1.0, longest), std::max(this->Smoothing * MostBeyondVoxel, longest));
  options.Tolerance = this->VoxelToleranceInUse();
  return options;
}
}
