// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRestCriterion_h
#define volumicRestCriterion_h

#include <cmath>
#include <vector>

namespace volumic
{
/**
 * Decides when a level rests: the enclosed volume has changed by less than a limit over both the
 * last 10 and the last 20 iterations. Mean speed stops while tips still grow, a count of moving
 * vertices never ends. Volumes: any unit, the same for all.
 */
class RestCriterion
{
public:
  void Reset() { this->Volumes.clear(); }
  void Add(double volume) { this->Volumes.push_back(volume); }

  bool IsMet(double limit) const
  {
    const std::size_t n = this->Volumes.size();
    return n > 20 && std::abs(this->Volumes[n - 1] - this->Volumes[n - 11]) < limit &&
      std::abs(this->Volumes[n - 1] - this->Volumes[n - 21]) < limit;
  }

private:
  std::vector<double> Volumes;
};
}

#endif
