// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Segments as 3D Slicer tells of them in the headers of .seg.nrrd:
//   Segment0_Name:=liver
//   Segment0_LabelValue:=1
//   Segment0_Color:=0.86 0.51 0.4
//   Segment0_Layer:=0
// Older files have a component per segment, and neither label nor layer.
#include "LabelNames.h"
#include "ParseNumbers.h"

#include <limits>
#include <locale>
#include <sstream>

namespace tool
{
namespace
{
using Pairs = std::map<std::string, std::string>;

/** A whole number; what is none counts as missing. */
int NumberAt(const Pairs& pairs, const std::string& key, int otherwise)
{
  const auto found = pairs.find(key);
  return found == pairs.end() ? otherwise : AsNumber<int>(found->second).value_or(otherwise);
}

std::optional<Vector3> ColorAt(const Pairs& pairs, const std::string& key)
{
  const auto found = pairs.find(key);
  std::istringstream words(found == pairs.end() ? "" : found->second);
  words.imbue(std::locale::classic());
  Vector3 color;
  words >> color[0] >> color[1] >> color[2];
  return words ? std::optional<Vector3>(color) : std::nullopt;
}

/** Without the marks of NRRD for line ends and backslashes. */
std::string Unmarked(const std::string& text)
{
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at)
  {
    const bool isMark =
      text[at] == '\\' && at + 1 < text.size() && (text[at + 1] == 'n' || text[at + 1] == '\\');
    plain += !isMark ? text[at] : (text[at + 1] == 'n' ? ' ' : '\\');
    at += isMark ? 1 : 0;
  }
  return plain;
}
}

LabelNames NamesOfSegments(const Pairs& pairs, int components)
{
  LabelNames names;
  for (const auto& [key, text] : pairs)
  {
    const std::string start = key.substr(0, key.find('_') + 1);
    if (key.compare(0, 7, "Segment") != 0 || start.size() < 9 || key != start + "Name")
    {
      continue;
    }
    const std::optional<int> number = AsNumber<int>(start.substr(7, start.size() - 8));
    if (!number || *number == std::numeric_limits<int>::max())
    {
      continue; // Segmentation_..., which is about all of them
    }
    const bool isOld = components > 1 && pairs.count(start + "Layer") == 0;
    LabelName name;
    name.Name = PlainName(Unmarked(text));
    name.Label = NumberAt(pairs, start + "LabelValue", isOld ? 1 : *number + 1);
    name.Layer = NumberAt(pairs, start + "Layer", isOld ? *number : 0);
    name.Color = ColorAt(pairs, start + "Color");
    names.push_back(name);
  }
  return names;
}
}
