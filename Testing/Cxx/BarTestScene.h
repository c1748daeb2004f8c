// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBarTestScene_h
#define volumicBarTestScene_h

#include "CoreTestTools.h"

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

/** A plate of such bars, 44 x 112 x 112 units wide, at voxels so many units apart. */
inline TestVolume Plate(double unit)
{
  constexpr int Width = 44;
  constexpr int Length = 112;
  const auto count = [unit](int n) { return static_cast<int>(std::lround(n / unit)); };
  TestVolume volume;
  LevelImage& image = volume.Image;
  image.Size = { count(Width), count(Length), count(Length) };
  for (int k = 0; k < image.Size[2]; ++k)
  {
    for (int j = 0; j < image.Size[1]; ++j)
    {
      for (int i = 0; i < image.Size[0]; ++i)
      {
        const double x = i * unit;
        const double y = j * unit;
        const double z = k * unit;
        const double outside = std::max({ std::abs(x - 0.5 * Width) - 0.5 * Width,
          std::abs(y - 0.5 * Length) - 0.5 * Length, std::abs(z - 0.5 * Length) - 0.5 * Length });
        const auto inside = [](double t) { return 24. + std::remainder(t - 24., 28.); };
        const double bars = Bars(inside(x), inside(y), inside(z));
        volume.Values.push_back(
          static_cast<float>(Soft(std::max(bars, outside + 4.) / unit)));
      }
    }
  }
  image.Values = volume.Values.data();
  image.Step = { unit, unit, unit };
  image.Unit = unit;
  return volume;
}
}

#endif
