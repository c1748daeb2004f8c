// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Settings/SegmentationSettings.h"

#include "Core/Common/Join.h"

#include <cmath>

namespace volumic
{
namespace
{
/** Return the property that requests a grading, for messages. */
std::string DescribeGrading(const Grading& grading)
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
        name, " is ", value, ". Set it to 0 (", zero, ") or more, in world units.");
    }
  };
  checkLength("Tolerance", grading.Tolerance, "edges of one length");
  checkLength("Maximum Edge Length", grading.MaximumEdgeLength, "automatic");
  if (!(grading.Gradation > 0.0) || grading.Gradation > Grading::MostGradation)
  {
    ThrowInvalidArgument("Gradation is ", grading.Gradation, ". Set it to more than 0 and at most ",
      Grading::MostGradation, ".");
  }
  if (grading.IsRequested() && edgeLength != 0.0)
  {
    ThrowInvalidArgument(DescribeGrading(grading), " and Edge Length is ", edgeLength,
      ", but graded edges have no uniform length. Set Edge Length to 0, or ",
      grading.HasTolerance() ? "set Tolerance to 0" : "",
      grading.HasTolerance() && grading.ThinParts ? " and " : "",
      grading.ThinParts ? "switch Thin Parts off" : "", ".");
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
      ". Set it to at least 1.");
  }
  if (this->SnapshotInterval < 0)
  {
    ThrowInvalidArgument(
      "Snapshot Interval is ", this->SnapshotInterval, ". Set it to 0 (none) or more.");
  }
  if (options.SeedRadius < 0.0 || !std::isfinite(options.SeedRadius))
  {
    ThrowInvalidArgument(
      "Seed Radius is ", options.SeedRadius, ". Set it to 0 (automatic) or more.");
  }
  CheckGrading(this->Grading, this->EdgeLength);
  if (this->Grading.IsRequested() && !options.Drive().LiesAtIsoValue)
  {
    ThrowInvalidArgument(DescribeGrading(this->Grading), ", but ",
      options.SnapToIsoValue ? "Isopotential Weight is not more than Edge Attraction Weight"
                             : "Snap To Iso Value is off",
      ", so the surface is not on the isosurface. ",
      this->Grading.HasTolerance() ? "Set Tolerance to 0, or " : "Switch Thin Parts off, or ",
      options.SnapToIsoValue ? "set a larger Isopotential Weight."
                             : "switch Snap To Iso Value on.");
  }
}
}
