// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCycleCriterion_h
#define volumicCycleCriterion_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * Recognises a level that never rests though it gets nowhere: what it merges it cuts again, or its
 * vertices swing, and the enclosed volume goes to and fro. Fed with the volume at every fifth
 * iteration, as ConvergenceCriterion. Volumes: any unit.
 *
 * Over the last 80 iterations the mean of the younger half is that of the older, within what counts
 * as rest at the pace of ConvergenceCriterion (its limit over 20 iterations), or within a quarter
 * of the swing. A volume that grows or shrinks steadily, however slowly, differs between the halves
 * by more than it does within one.
 */
class CycleCriterion
{
public:
  void Add(double volume) { this->Volumes.push_back(volume); }

  bool IsMet(double limit) const
  {
    if (this->Volumes.size() < 2 * static_cast<std::size_t>(Half))
    {
      return false;
    }
    const auto middle = this->Volumes.end() - Half;
    const Swing older(middle - Half, middle);
    const Swing younger(middle, this->Volumes.end());
    // The means of the halves are 40 iterations apart.
    return std::abs(younger.Mean - older.Mean) <
      std::max(2. * limit, 0.25 * std::min(older.Width, younger.Width));
  }

private:
  static constexpr std::ptrdiff_t Half = 8; ///< Samples.

  struct Swing
  {
    double Mean = 0.;
    double Width = 0.;

    using Place = std::vector<double>::const_iterator;
    Swing(Place begin, Place end)
    {
      const auto range = std::minmax_element(begin, end);
      this->Width = *range.second - *range.first;
      for (Place place = begin; place != end; ++place)
      {
        this->Mean += *place / static_cast<double>(end - begin);
      }
    }
  };
  std::vector<double> Volumes;
};
}

#endif
