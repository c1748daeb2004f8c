// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckGrading_h
#define volumicCheckGrading_h

#include "Core/Common/Grading.h"
#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"

#include <cmath>
#include <string>

namespace volumic
{
/** Why there is a grading, for an error. */
inline std::string WhatGrades(const Grading& grading)
{
  return grading.HasTolerance() ? Join("Tolerance is ", grading.Tolerance) : "Thin Parts is on";
}

/** @throws std::invalid_argument naming the property that is out of range. */
inline void CheckGrading(const Grading& grading, double edgeLength)
{
  const auto isLength = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!isLength(grading.Tolerance))
  {
    Refuse("Tolerance is ", grading.Tolerance,
      "; it must be 0 (edges of one length) or more, in world units.");
  }
  if (!isLength(grading.MaximumEdgeLength))
  {
    Refuse("Maximum Edge Length is ", grading.MaximumEdgeLength,
      "; it must be 0 (automatic) or more, in world units.");
  }
  if (!(grading.Gradation > 0.0) || grading.Gradation > Grading::MostGradation)
  {
    Refuse("Gradation is ", grading.Gradation, "; it must be more than 0 and at most ",
      Grading::MostGradation, ".");
  }
  if (grading.IsWanted() && edgeLength != 0.0)
  {
    Refuse(WhatGrades(grading), " and Edge Length is ", edgeLength, ": edges either ",
      grading.HasTolerance() ? "keep a tolerance" : "are shorter in thin parts",
      " or are of one length. Set Edge Length to 0, or switch ",
      grading.HasTolerance() && grading.ThinParts ? "Tolerance and Thin Parts" : "the other",
      " off.");
  }
}
}

#endif
