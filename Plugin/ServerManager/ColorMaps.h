// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/** Functions for ParaView's colour maps (proxies of PVLookupTable). */
#ifndef volumicColorMaps_h
#define volumicColorMaps_h

#include <array>
#include <string>
#include <vector>

class vtkSMProxy;

namespace volumic
{
/** A value of a categorical colour map. */
struct ColorCategory
{
  std::string Value;
  std::string Text; ///< in the legend
  std::array<double, 3> Color;
};

/** Return whether the colour map has a range or categories. */
bool IsInitialized(vtkSMProxy* colors);

constexpr std::array<double, 3> OtherColor = { 0.5, 0.5, 0.5 };

/** Set the categories. All other values get OtherColor. */
void SetCategories(vtkSMProxy* colors, const std::vector<ColorCategory>& categories);

/** Return the categories. */
std::vector<ColorCategory> CategoriesOf(vtkSMProxy* colors);

/** Compare categories. ParaView's colour map editor rounds colours to 16 bits without an edit. */
bool AreSame(const std::vector<ColorCategory>& one, const std::vector<ColorCategory>& other);
}

#endif
