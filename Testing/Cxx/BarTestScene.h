// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBarTestScene_h
#define volumicBarTestScene_h

#include "CoreTestTools.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
/** A lattice of bars, thick and thin: merges, cuts, lost parts and cavities. */
inline double Bars(double x, double y, double z)
{
  const auto distance = [](double t) { return std::abs(std::remainder(t, 14.)); };
  const double u = distance(x - 3);
  const double v = distance(y - 3);
  const double w = distance(z - 3);
  const double thick = std::min({ std::hypot(u, v), std::hypot(v, w), std::hypot(u, w) });
  const double hollow = 2.6 - Distance(x, y, z, 24, 24, 24);
  const double outside = std::max({ std::abs(x - 24), std::abs(y - 24), std::abs(z - 24) }) - 20;
  return std::max({ thick - 2.1 - 0.8 * std::sin(0.3 * x), hollow, outside });
}

/** Level 0 of them; the iso-value is .5. */
inline TestVolume FineBars()
{
  return MakeVolume(48, [](double x, double y, double z) { return Soft(Bars(x, y, z)); });
}

/** Level 1. */
inline TestVolume CoarseBars()
{
  constexpr double f = 48. / 27;
  TestVolume coarse = MakeVolume(27,
    [](double x, double y, double z) { return Soft(Bars(x * f, y * f, z * f) / f); });
  coarse.Image.Step = { f, f, f };
  coarse.Image.Unit = std::sqrt(3.);
  return coarse;
}
}

#endif
