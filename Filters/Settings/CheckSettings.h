// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckSettings_h
#define volumicCheckSettings_h

#include "Core/Common/Grading.h"
#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"

#include <cmath>
#include <string>

namespace volumic
{
/**
 * Properties of VTK classes give enumerations as any int: this refuses what is none of them.
 * @param name of the property, for the message
 * @param last the largest of the enumeration, which begins at 0 and leaves none out
 */
template <typename Enumeration>
void CheckEnumeration(const char* name, Enumeration value, Enumeration last)
{
  const int number = static_cast<int>(value);
  if (number < 0 || value > last)
  {
    Refuse(name, " is ", number, "; it must be 0 to ", static_cast<int>(last), ".");
  }
}

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
