// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelShapes.h"

#include "ForVoxels.h"
#include "JudgeInternals.h"
#include "SyntheticScenes.h"

#include <algorithm>
#include <cmath>

namespace volumic::support
{
namespace
{

using Vector = std::array<double, 3>;
using Implicit = std::function<double(const Vector&)>;

constexpr double Pi = 3.14159265358979323846;
/** Reference units of the smallest extent. */
constexpr double ReferenceSize = 64.0;

Implicit Ball(const Vector& centre, double radius)
{
  return [centre, radius](const Vector& p) { return Norm(Difference(p, centre)) - radius; };
}

double BallVolume(double radius)
{
  return 4.0 / 3.0 * Pi * radius * radius * radius;
}

/** Return the smooth maximum, with a radius of about .7 `rounding`. */
double RoundedMaximum(double a, double b, double rounding)
{
  const double h = std::max(rounding - std::abs(a - b), 0.0) / rounding;
  return std::max(a, b) + 0.25 * h * h * rounding;
}

double GyroidInBall(const Vector& p)
{
  const double turns = 2.0 * Pi / 27.0;
  const double x = turns * (p[0] + 3.1), y = turns * (p[1] - 1.7), z = turns * (p[2] + 0.9);
  const double sheet =
    std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
  const Vector slope = { std::cos(x) * std::cos(y) - std::sin(z) * std::sin(x),
    std::cos(y) * std::cos(z) - std::sin(x) * std::sin(y),
    std::cos(z) * std::cos(x) - std::sin(y) * std::sin(z) };
  const double distance = sheet / std::hypot(Norm(slope), 0.3) / turns;
  return RoundedMaximum(distance, Norm(p) - 27.0, 8.0);
}

constexpr double GyroidVolume = 32771.1; // by sampling with a spacing of .2

/** Wedge between two half planes at the z axis, at angles less than pi apart. */
Implicit Sector(double from, double to)
{
  return [from, to](const Vector& p)
  {
    return std::max(
      std::sin(from) * p[0] - std::cos(from) * p[1], std::cos(to) * p[1] - std::sin(to) * p[0]);
  };
}

/** Return the shapes in reference units, around 0. The last shape has priority. */
std::vector<LabelShape> ShapesOf(LabelShapeKind kind)
{
  switch (kind)
  {
    case LabelShapeKind::Sphere:
      return { { 1, DistanceOf(SceneKind::Sphere), BallVolume(20.0) } };
    case LabelShapeKind::Torus:
      return { { 1, DistanceOf(SceneKind::Torus), 2.0 * Pi * Pi * 17.0 * 7.5 * 7.5 } };
    case LabelShapeKind::Gyroid:
      return { { 1, GyroidInBall, GyroidVolume } };
    case LabelShapeKind::TouchingBalls: // 25 apart, the sum of the radii
      return { { 1, Ball({ -3.607, -6.0117, -9.739 }, 14.1), BallVolume(14.1) },
        { 2, Ball({ 3.9076, 6.5127, 10.5506 }, 10.9), BallVolume(10.9) } };
    case LabelShapeKind::CutBall:
      break;
  }
  std::vector<LabelShape> shapes;
  for (int s = 0; s < 3; ++s)
  {
    const double from = 0.4 + 2.0 * Pi / 3.0 * s;
    const Implicit sector = Sector(from, from + 2.0 * Pi / 3.0);
    shapes.push_back(
      { s + 1, [sector](const Vector& p) { return std::max(sector(p), Norm(p) - 24.3); } });
  }
  shapes.push_back({ 4, Ball({ 0.3, 0.2, -0.4 }, 10.2), BallVolume(10.2) });
  return shapes;
}

} // namespace

DigitisedShapes Digitise(LabelShapeKind kind, int size, double stretch)
{
  DigitisedShapes result;
  LabelMap& map = result.Map;
  map.Size = { size, size, static_cast<int>(std::ceil(size / stretch)) };
  map.Spacing = { 1.0, 1.0, stretch };
  map.Values.resize(static_cast<std::size_t>(size) * size * map.Size[2]);
  Vector centre;
  for (int a = 0; a < 3; ++a)
  {
    centre[a] = 0.5 * (map.Size[a] - 1) * map.Spacing[a];
  }
  const double unit = size / ReferenceSize;
  result.Shapes = ShapesOf(kind);
  for (LabelShape& shape : result.Shapes)
  {
    shape.Distance = [=, reference = shape.Distance](const Vector& p)
    {
      return unit *
        reference(
          { (p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit });
    };
    shape.Volume *= unit * unit * unit;
    std::size_t voxel = 0;
    ForVoxels(map.Size,
      [&](int i, int j, int k)
      {
        if (shape.Distance({ 1.0 * i, 1.0 * j, stretch * k }) < 0.0)
        {
          map.Values[voxel] = static_cast<std::int16_t>(shape.Label);
        }
        ++voxel;
      });
  }
  return result;
}
} // namespace volumic::support
