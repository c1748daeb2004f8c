// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/** What displays set of ParaView's colour maps (proxies of PVLookupTable). */
#ifndef volumicColorMaps_h
#define volumicColorMaps_h

#include <array>
#include <string>
#include <vector>

class vtkSMProxy;

namespace volumic
{
/** A value that a colour map tells apart from others, instead of a range. */
struct ColorCategory
{
  std::string Value;
  std::string Text; ///< beside its colour, in a legend
  std::array<double, 3> Color;
};

/** Whether somebody, here, in ParaView or at it, has given it a range or categories. */
bool HasGotItsRange(vtkSMProxy* colors);

constexpr std::array<double, 3> ColorOfOthers = { 0.5, 0.5, 0.5 };

/** All other values get the grey. */
void SetCategories(vtkSMProxy* colors, const std::vector<ColorCategory>& categories);

std::vector<ColorCategory> CategoriesOf(vtkSMProxy* colors);

/** But for what ParaView's editor of colour maps rounds, also where nobody edits: to 16 bits. */
bool AreSame(const std::vector<ColorCategory>& one, const std::vector<ColorCategory>& other);
}

#endif
