// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSettings.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Input/ComputationalSpace.h"
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
/** In smallest voxel spacings. Signs are constrained up to 1.5 voxels from boundaries. */
constexpr double MaximumTolerance = 1.0;

/**
 * Unit of Smoothing as a fraction of the largest voxel spacing, which is the height of voxel steps.
 * With a larger fraction parts bulge that are thin along other axes.
 */
constexpr double FractionOfLargest = 0.625;

/** Limit in thick slices: the Gaussian is at most this times Smoothing, or the unit. */
constexpr double MaximumUnit = 2.5;

void CheckNumber(const char* name, double value)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    ThrowInvalidArgument(name, " is ", value, ". Set it to 0 (none) or more.");
  }
}

/** @throws InvalidArgument naming the possible lengths, up to about this number of voxels */
void CheckEdgeLength(double length, vtkImageData* image, double longest)
{
  PyramidOptions pyramid;
  const int enough = static_cast<int>(std::min(longest, 1e5)) * pyramid.MinimumLevelSize;
  vtkNew<vtkImageData> frame;
  frame->SetDimensions(enough, enough, enough);
  frame->SetSpacing(image->GetSpacing());
  PlanEdgeLength(length, SurfaceOptions().SamplingRatio, frame, pyramid);
}
}

void LabelSettings::Check(vtkImageData* image) const
{
  CheckNumber("Smoothing", this->Smoothing);
  if (this->Smoothing > 10.0)
  {
    ThrowInvalidArgument("Smoothing is ", this->Smoothing, " voxels. Set it to at most 10.");
  }
  if (this->VoxelTolerance != -1.0 &&
    !(this->VoxelTolerance >= 0.0 && this->VoxelTolerance <= MaximumTolerance))
  {
    ThrowInvalidArgument("Voxel Tolerance is ", this->VoxelTolerance, ". Set it to 0 to ",
      MaximumTolerance, " voxels, or to -1 (a quarter of Smoothing).");
  }
  if (this->BoxFaces < 0 || this->BoxFaces > 2)
  {
    ThrowInvalidArgument(
      "Box Faces is ", this->BoxFaces, ". Set it to 0 (rounded), 1 (flat) or 2 (periodic).");
  }
  CheckNumber("Edge Length", this->EdgeLength);
  CheckGrading(this->Grading, this->EdgeLength);
  CheckNumber("Minimum Component Volume", this->MinimumComponentVolume);
  const double longest =
    image->GetLength() / ComputationalSpace(image, volumic::Metric::World).WorldUnit();
  if (this->FinestLevel < -1 || std::pow(std::sqrt(3.0), this->FinestLevel) > longest)
  {
    ThrowInvalidArgument("Finest Level is ", this->FinestLevel,
      ". Set it to -1 or more, with edges not longer than the image.");
  }
  CheckEnumeration("Metric", static_cast<volumic::Metric>(this->Metric), volumic::Metric::World);
  const auto keep = static_cast<KeepComponentsType>(this->KeepComponents);
  if (keep != KeepComponentsType::AllComponents && keep != KeepComponentsType::LargestComponent &&
    keep != KeepComponentsType::LargeComponents)
  {
    ThrowInvalidArgument("Keep Components is ", this->KeepComponents,
      ". Set it to 0 (all), 1 (the largest) or 3 (large ones) for labels.");
  }
  if (this->EdgeLength > 0.0)
  {
    CheckEdgeLength(this->EdgeLength, image, longest);
  }
}

LabelFieldOptions LabelSettings::FieldOptions(const LabelMap& map) const
{
  const double unit = FractionOfLargest * *std::max_element(map.Spacing.begin(), map.Spacing.end());
  LabelFieldOptions options;
  options.Sigma =
    std::min(this->Smoothing * std::max(1.0, unit), std::max(this->Smoothing * MaximumUnit, unit));
  options.Tolerance = this->VoxelToleranceInUse();
  return options;
}
}
