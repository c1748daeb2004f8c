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
/** What labels are called and how they are coloured. */
struct LabelNames
{
  using Color = std::array<double, 3>; ///< red, green, blue, 0 to 1

  std::map<int, std::string> Names;
  std::map<int, Color> Colors;

  /**
   * Those in the field data of a label map: `LabelValues`, and with as many entries `LabelNames`
   * and `LabelColors`.
   * @throws std::invalid_argument naming the array that has another number of entries.
   */
  static LabelNames Of(vtkDataObject* image);

  /** What is missing here is taken from others. */
  void Complete(const LabelNames& others);

  /** Its name, or `Label 3`. */
  std::string NameOf(int label) const;
  /** `Label 3`, or `Labels 1, 3` for several without names. */
  std::string NameOf(const std::vector<int>& labels) const;
  /** Its colour, or one of a fixed palette. */
  Color ColorOf(int label) const;
};

/** Return the first texts as a list: `liver, kidney and 3 others`. */
std::string Listed(const std::vector<std::string>& texts, std::size_t most);
}

#endif
