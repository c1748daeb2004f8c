// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelNames_h
#define volumicLabelNames_h

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

class vtkDataObject;

namespace volumic
{
struct LabelNames
{
  using Color = std::array<double, 3>; ///< red, green, blue, 0 to 1

  std::map<int, std::string> Names;
  std::map<int, Color> Colors;

  /**
   * Return the names and colors in the field data of a label map: `LabelValues`, and with an entry
   * for each value `LabelNames` and `LabelColors`.
   * @throws InvalidArgument naming an array with another number of entries or components
   */
  static LabelNames Of(vtkDataObject* image);

  /** Add missing names and colors from others. */
  void Complete(const LabelNames& others);

  /** Return the name, or `Label 3`. */
  std::string NameOf(int label) const;
  /** Return the name of a single label, or `Labels 1, 3`. */
  std::string NameOf(const std::vector<int>& labels) const;
  /** Return the color, or a color of a fixed palette. */
  Color ColorOf(int label) const;
};

/** Return the first texts as a list: `liver, kidney and 3 others`. */
std::string Listed(const std::vector<std::string>& texts, std::size_t most);
}

#endif
