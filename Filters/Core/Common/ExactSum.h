// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicExactSum_h
#define volumicExactSum_h

#include <cmath>
#include <cstdint>

namespace volumic
{
/**
 * A sum of doubles that does not depend on their order: each is rounded to a multiple of 2^-40, and
 * these are added as integers. So what threads have summed up, each its own part, adds up to
 * the same bits however the parts are cut. For terms whose absolute values add up to less than
 * 2^54, and fewer than 2^31 of them.
 */
class ExactSum
{
public:
  void Add(double term)
  {
    const double coarse = std::nearbyint(term * CoarseInOne);
    this->Coarse += static_cast<std::int64_t>(coarse);
    // What is left is exact, and at most half a coarse unit.
    const double rest = term - coarse / CoarseInOne;
    this->Fine += static_cast<std::int64_t>(std::nearbyint(rest * FineInOne));
  }
  void Add(const ExactSum& other)
  {
    this->Coarse += other.Coarse;
    this->Fine += other.Fine;
  }
  double Value() const
  {
    return static_cast<double>(this->Coarse) / CoarseInOne +
      static_cast<double>(this->Fine) / FineInOne;
  }

private:
  static constexpr double CoarseInOne = 256.;                 // 2^8
  static constexpr double FineInOne = 256. * 4294967296.; // 2^40
  std::int64_t Coarse = 0;
  std::int64_t Fine = 0;
};
}

#endif
