// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The labels of a label map, or of surfaces, on ParaView's client: found where the data is, by the
 * helper proxy (internal_filters, LabelList).
 */
#ifndef volumicLabelRows_h
#define volumicLabelRows_h

#include <array>
#include <string>
#include <vector>

class vtkSMSourceProxy;

namespace volumic
{
struct LabelRow
{
  int Label = 0;
  std::string Name;
  long long Voxels = 0;
  std::array<double, 3> Color = { { 0.0, 0.0, 0.0 } };
};

struct LabelRows
{
  std::vector<LabelRow> Rows; ///< of a label map by value, of surfaces in the order of their blocks
  std::string Problem;        ///< why there are none
};

/**
 * Of a label map, or of the output of Labels to Surfaces. `array` is as SetInputArrayToProcess has it;
 * empty: the active scalars.
 */
LabelRows FetchLabels(
  vtkSMSourceProxy* producer, unsigned int port, const std::array<std::string, 5>& array = {});
}

#endif
