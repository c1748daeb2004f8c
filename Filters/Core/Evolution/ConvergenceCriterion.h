// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicConvergenceCriterion_h
#define volumicConvergenceCriterion_h

#include <cmath>
#include <vector>

namespace volumic
{
/**
 * Convergence of a level: the enclosed volume has changed by less than a limit over the last 10 and
 * the last 20 iterations. The mean speed vanishes while tips still grow, and the number of moving
 * vertices may never reach zero. The volume is sampled every fifth iteration, in any unit.
 */
class ConvergenceCriterion
{
public:
  static constexpr int Interval = 5; ///< iterations between samples

  void Add(double volume) { this->Volumes.push_back(volume); }

  bool IsMet(double limit) const
  {
    constexpr std::size_t ten = 10 / Interval;
    const std::size_t n = this->Volumes.size();
    return n > 2 * ten && std::abs(this->Volumes[n - 1] - this->Volumes[n - 1 - ten]) < limit &&
      std::abs(this->Volumes[n - 1] - this->Volumes[n - 1 - 2 * ten]) < limit;
  }

private:
  std::vector<double> Volumes;
};
}

#endif
