// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What BenchmarkLabels is told. */

#ifndef volumicLabelBenchmarkOptions_h
#define volumicLabelBenchmarkOptions_h

#include "LabelRuns.h"

#include <array>
#include <string>
#include <vector>

namespace volumic::bench
{

struct LabelBenchmarkOptions
{
  std::string Map;                         ///< a file that is a label map, or
  std::string Scan;                        ///< one to make labels of, or
  std::array<int, 3> Body = { 0, 0, 0 };   ///< voxels of a map to be made; else shapes
  std::vector<double> Thresholds;          ///< of Scan
  bool Mask = false;                       ///< all labels of the map as one
  int BodyLabels = 104;
  std::vector<int> Sizes = { 64, 128 };    ///< of shapes
  std::vector<double> Stretches = { 1.0, 3.0 };
  std::vector<std::string> Shapes;         ///< none: all
  std::vector<int> Labels;                 ///< none: all
  long long LeastVoxels = 64;              ///< of a label, to be measured
  std::vector<std::string> Runs;           ///< none: all
  LabelSettings Settings;

  bool IsOfShapes() const { return this->Map.empty() && this->Scan.empty() && this->Body[0] == 0; }
};

} // namespace volumic::bench

#endif
