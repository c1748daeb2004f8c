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
 * Limit cycle of a level: merges and cuts alternate, or vertices oscillate, so that the enclosed
 * volume oscillates without a trend. The volume is sampled every fifth iteration, in any unit.
 *
 * The criterion compares the means of the older and the younger half of the last 80 iterations.
 * They must differ by less than twice the limit of ConvergenceCriterion, or than a quarter of the
 * amplitude. A steady trend, however slow, exceeds this.
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
  static constexpr std::ptrdiff_t Half = 8; ///< in samples

  struct Swing
  {
    double Mean = 0.;
    double Width = 0.;

    using Iterator = std::vector<double>::const_iterator;
    Swing(Iterator begin, Iterator end)
    {
      const auto range = std::minmax_element(begin, end);
      this->Width = *range.second - *range.first;
      for (Iterator at = begin; at != end; ++at)
      {
        this->Mean += *at / static_cast<double>(end - begin);
      }
    }
  };
  std::vector<double> Volumes;
};
}

#endif
