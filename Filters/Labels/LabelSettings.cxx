// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelSettings.h"

#include "Core/Common/Refuse.h"
#include "Core/Labels/LabelField.h"
#include "Settings/SegmentationSettings.h"

#include <cmath>

namespace volumic
{
namespace
{
/** In smallest distances of voxels: signs are held a voxel and a half from boundaries. */
constexpr double MostTolerance = 1.0;

/** Twice what fields reach, in smallest distances of voxels. */
constexpr double MostGap = 2.0 * LabelField::Far;

void CheckNumber(const char* name, double value)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    Refuse(name, " is ", value, "; it must be 0 (none) or more.");
  }
}
}

void LabelSettings::Check(double unit) const
{
  CheckNumber("Smoothing", this->Smoothing);
  if (this->Smoothing > 10.0)
  {
    Refuse("Smoothing is ", this->Smoothing, " voxels; it must be at most 10.");
  }
  CheckNumber("Voxel Tolerance", this->VoxelTolerance);
  if (this->VoxelTolerance > MostTolerance)
  {
    Refuse("Voxel Tolerance is ", this->VoxelTolerance, " voxels; it must be at most ",
      MostTolerance, ".");
  }
  CheckNumber("Gap", this->Gap);
  if (this->Gap > MostGap * unit)
  {
    Refuse("Gap is ", this->Gap, "; it must be at most ", MostGap * unit,
      ", eight times the smallest distance of voxels: fields of labels reach no further.");
  }
  if (this->SharedInterfaces && this->Gap > 0.0)
  {
    Refuse("Shared Interfaces are asked for and a Gap of ", this->Gap,
      ": neighbours have the same triangles, or space between them. Set Gap to 0, or switch "
      "Shared Interfaces off (files for meshers of solids, .msh, .smesh and .poly, need them).");
  }
  if (this->SharedInterfaces && this->Grading.ThinParts)
  {
    Refuse(
      "Thin Parts are asked for and Shared Interfaces, which have no smaller triangles where "
      "labels are thin. Switch Thin Parts off, or Shared Interfaces (files for meshers of solids, "
      ".msh, .smesh and .poly, need them); a shorter Edge Length makes all triangles smaller.");
  }
  if (this->BoxFaces < 0 || this->BoxFaces > 2)
  {
    Refuse("Box Faces is ", this->BoxFaces, "; it must be 0 (rounded), 1 (flat) or 2 (periodic).");
  }
  if (this->HasFlatBox() && !this->SharedInterfaces)
  {
    Refuse("Box Faces are to be flat, as only Shared Interfaces can have them. Switch Shared "
           "Interfaces on, or set Box Faces to rounded.");
  }
  CheckNumber("Edge Length", this->EdgeLength);
  CheckGrading(this->Grading, this->EdgeLength);
  CheckNumber("Minimum Component Volume", this->MinimumComponentVolume);
  if (this->FinestLevel < -1)
  {
    Refuse("Finest Level is ", this->FinestLevel, "; it must be -1 or more.");
  }
  if (this->Metric != 0 && this->Metric != 1)
  {
    Refuse("Metric is ", this->Metric, "; it must be 0 (Voxels) or 1 (World).");
  }
  const auto keep = static_cast<KeepComponentsType>(this->KeepComponents);
  if (keep != KeepComponentsType::AllComponents && keep != KeepComponentsType::LargestComponent &&
    keep != KeepComponentsType::LargeComponents)
  {
    Refuse("Keep Components is ", this->KeepComponents,
      "; for labels it must be 0 (all), 1 (the largest) or 3 (large ones).");
  }
}
}
