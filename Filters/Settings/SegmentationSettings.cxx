// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Settings/SegmentationSettings.h"

#include "Core/Common/Join.h"

#include <cmath>

namespace volumic
{
namespace
{
/** Why there is a grading, for an error. */
std::string WhatGrades(const Grading& grading)
{
  return grading.HasTolerance() ? Join("Tolerance is ", grading.Tolerance) : "Thin Parts is on";
}
}

void CheckGrading(const Grading& grading, double edgeLength)
{
  const auto checkLength = [](const char* name, double value, const char* zero)
  {
    if (!(value >= 0.0 && std::isfinite(value)))
    {
      ThrowInvalidArgument(
        name, " is ", value, "; it must be 0 (", zero, ") or more, in world units.");
    }
  };
  checkLength("Tolerance", grading.Tolerance, "edges of one length");
  checkLength("Maximum Edge Length", grading.MaximumEdgeLength, "automatic");
  if (!(grading.Gradation > 0.0) || grading.Gradation > Grading::MostGradation)
  {
    ThrowInvalidArgument("Gradation is ", grading.Gradation,
      "; it must be more than 0 and at most ", Grading::MostGradation, ".");
  }
  if (grading.IsRequested() && edgeLength != 0.0)
  {
    ThrowInvalidArgument(WhatGrades(grading), " and Edge Length is ", edgeLength, ": edges either ",
      grading.HasTolerance() ? "keep a tolerance" : "are shorter in thin parts",
      " or are of one length. Set Edge Length to 0, or switch ",
      grading.HasTolerance() && grading.ThinParts ? "Tolerance and Thin Parts" : "the other",
      " off.");
  }
}

void SegmentationSettings::Check() const
{
  const SurfaceOptions& options = this->Options;
  CheckEnumeration("Initialization", this->Initialization, InitializationType::InputSurface);
  CheckEnumeration("Border Value", options.BorderValue, Border::Replicate);
  CheckEnumeration("Recovery", this->Recovery, RecoveryType::RecoverObjectsAndCavities);
  if (options.MaximumNumberOfIterations < 1)
  {
    ThrowInvalidArgument("Maximum Number Of Iterations is ", options.MaximumNumberOfIterations,
      "; it must be at least 1.");
  }
  if (this->SnapshotInterval < 0)
  {
    ThrowInvalidArgument(
      "Snapshot Interval is ", this->SnapshotInterval, "; it must be 0 (off) or more.");
  }
  if (options.SeedRadius < 0.0 || !std::isfinite(options.SeedRadius))
  {
    ThrowInvalidArgument(
      "Seed Radius is ", options.SeedRadius, "; it must be 0 (automatic) or more.");
  }
  CheckGrading(this->Grading, this->EdgeLength);
  if (this->Grading.IsRequested() && !options.Drive().LiesAtIsoValue)
  {
    ThrowInvalidArgument(WhatGrades(this->Grading), ", but ",
      options.SnapToIsoValue ? "Isopotential Weight is not more than Edge Attraction Weight"
                             : "Snap To Iso Value is off",
      ": the surface does not lie at the iso-value, from which ",
      this->Grading.HasTolerance() ? "a tolerance is measured. Set it to 0"
                                   : "thickness is. Switch it off",
      ", or change that.");
  }
}
}
