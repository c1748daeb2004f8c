// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelList.h"

#include "Json.h"
#include "Report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace tool
{
namespace
{
using Row = std::vector<std::string>;

double VolumeOf(const KnownLabel& label, const VolumeFacts& volume)
{
  const Vector3& spacing = volume.Spacing;
  return static_cast<double>(label.Voxels) * spacing[0] * spacing[1] * spacing[2];
}

/** Six digits, but no powers of ten. */
std::string SixDigits(double value)
{
  const int digits = value > 0.0 ? 5 - static_cast<int>(std::floor(std::log10(value))) : 0;
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", std::clamp(digits, 0, 30), value);
  return text;
}

std::string BoxText(const std::array<int, 6>& box)
{
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    text += (axis > 0 ? " " : "") + std::to_string(box[2 * axis]) + ".." +
      std::to_string(box[2 * axis + 1]);
  }
  return text;
}

Row RowOf(const KnownLabel& label, const LabelList& list)
{
  Row row = { std::to_string(label.Label), std::to_string(label.Voxels),
    SixDigits(VolumeOf(label, list.Volume)) };
  if (list.Layers > 1)
  {
    row.push_back(std::to_string(label.Layer));
  }
  row.push_back(BoxText(label.Box));
  row.push_back(PlainName(label.Name)); // the last, as it may be long
  return row;
}
}

void WriteTable(std::ostream& out, const LabelList& list)
{
  std::vector<Row> rows = { { "label", "voxels", "volume" } };
  if (list.Layers > 1)
  {
    rows.front().push_back("layer");
  }
  rows.front().emplace_back("box (first..last voxel along i, j, k)");
  rows.front().emplace_back("name");
  for (const KnownLabel& label : list.Labels)
  {
    rows.push_back(RowOf(label, list));
  }
  for (const Row& row : rows)
  {
    for (std::size_t column = 0; column < row.size(); ++column)
    {
      std::size_t width = 0;
      for (const Row& other : rows)
      {
        width = std::max(width, other[column].size());
      }
      const bool isLast = column + 1 == row.size();
      const std::string blanks(isLast ? 0 : width - row[column].size(), ' ');
      const bool isNumber = column + 2 < row.size();
      out << (isNumber ? blanks + row[column] : row[column] + blanks) << (isLast ? "\n" : "  ");
    }
  }
}

std::string ReportText(const LabelList& list)
{
  Json json = { { "input", InputFacts(list.VolumeName, list.Volume) },
    { "labels", Json::array() } };
  for (const KnownLabel& label : list.Labels)
  {
    json["labels"].push_back({ { "label", label.Label }, { "name", label.Name },
      { "color", AsJsonArray(label.Color) }, { "layer", label.Layer },
      { "voxels", label.Voxels }, { "volume", AsJson(VolumeOf(label, list.Volume)) },
      { "box", label.Box } });
  }
  return EndedReport(json, list.Warnings);
}
}
