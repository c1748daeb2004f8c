// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelShapes.h"

#include "ForVoxels.h"
#include "SceneShapes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace volumic::support
{
namespace
{

using Vector = std::array<double, 3>;
using Implicit = std::function<double(const Vector&)>;

constexpr double Pi = 3.14159265358979323846;
/** Reference units of the smallest extent, as in SceneShape. */
constexpr double ReferenceSize = 64.0;

/** A label in reference units, around 0. */
struct ReferenceShape
{
  int Label;
  Implicit Distance;
  double Volume;        ///< 0: computed by sampling
  bool IsSmooth = true; ///< false: without Distance in LabelShape
};

double Length(const Vector& p)
{
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

Implicit Ball(const Vector& centre, double radius)
{
  return [centre, radius](const Vector& p) {
    return Length({ p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] }) - radius;
  };
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
  const double distance = sheet / std::hypot(Length(slope), 0.3) / turns;
  return RoundedMaximum(distance, Length(p) - 27.0, 8.0);
}

/** Wedge between two half planes at the z axis, at angles less than pi apart. */
Implicit Sector(double from, double to)
{
  return [from, to](const Vector& p)
  {
    return std::max(
      std::sin(from) * p[0] - std::cos(from) * p[1], std::cos(to) * p[1] - std::sin(to) * p[0]);
  };
}

std::vector<ReferenceShape> CutBallShapes()
{
  std::vector<ReferenceShape> shapes;
  for (int s = 0; s < 3; ++s)
  {
    const double from = 0.4 + 2.0 * Pi / 3.0 * s;
    const Implicit sector = Sector(from, from + 2.0 * Pi / 3.0);
    shapes.push_back({ s + 1,
      [sector](const Vector& p) { return std::max(sector(p), Length(p) - 24.3); }, 0.0, false });
  }
  // The last shape has priority.
  shapes.push_back({ 4, Ball({ 0.3, 0.2, -0.4 }, 10.2), BallVolume(10.2) });
  return shapes;
}

std::vector<ReferenceShape> ShapesOf(LabelShapeKind kind)
{
  const Vector axis = { 0.3 / 0.9981, 0.5 / 0.9981, 0.81 / 0.9981 };
  const auto along = [&axis](double t) { return Vector{ axis[0] * t, axis[1] * t, axis[2] * t }; };
  switch (kind)
  {
    case LabelShapeKind::Sphere:
      return { { 1, MakeSceneShape(SceneKind::Sphere, 0.0).Distance, BallVolume(20.0) } };
    case LabelShapeKind::Torus:
      return { { 1, MakeSceneShape(SceneKind::Torus, 0.0).Distance,
        2.0 * Pi * Pi * 17.0 * 7.5 * 7.5 } };
    case LabelShapeKind::Gyroid:
      return { { 1, GyroidInBall, 0.0 } };
    case LabelShapeKind::TouchingBalls:
    {
      // The distance of the centres equals the sum of the radii.
      const double length = Length(axis);
      return { { 1, Ball(along(-12.0 / length), 14.1), BallVolume(14.1) },
        { 2, Ball(along(13.0 / length), 10.9), BallVolume(10.9) } };
    }
    case LabelShapeKind::CutBall:
      return CutBallShapes();
  }
  throw std::invalid_argument("Digitise: unknown kind of shape");
}

/** Measure a volume by sampling it on a grid of spacing .4. */
double MeasuredVolume(const Implicit& distance)
{
  const int count = 160;
  const double step = ReferenceSize / count;
  std::size_t inside = 0;
  const auto at = [step](int n) { return (n + 0.5) * step - 0.5 * ReferenceSize; };
  ForVoxels({ count, count, count },
    [&](int i, int j, int k) {
      inside += distance({ at(i), at(j), at(k) }) < 0.0;
    });
  return static_cast<double>(inside) * step * step * step;
}

} // namespace

std::string LabelShapeName(LabelShapeKind kind)
{
  constexpr std::array<const char*, 5> names = { "Sphere", "Torus", "Gyroid", "TouchingBalls",
    "CutBall" };
  return names.at(static_cast<std::size_t>(kind));
}

DigitisedShapes Digitise(LabelShapeKind kind, int size, double stretch)
{
  if (size < 32 || !(stretch >= 1.0))
  {
    throw std::invalid_argument("Digitise: size must be at least 32, stretch at least 1");
  }
  DigitisedShapes result;
  result.Name = LabelShapeName(kind);
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
  for (const ReferenceShape& shape : ShapesOf(kind))
  {
    const Implicit distance = [=](const Vector& p)
    {
      return unit *
        shape.Distance(
          { (p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit });
    };
    std::size_t voxel = 0;
    ForVoxels({ size, size, map.Size[2] },
      [&](int i, int j, int k)
      {
        if (distance({ 1.0 * i, 1.0 * j, stretch * k }) < 0.0)
        {
          map.Values[voxel] = static_cast<std::int16_t>(shape.Label);
        }
        ++voxel;
      });
    LabelShape truth;
    truth.Label = shape.Label;
    if (shape.IsSmooth)
    {
      truth.Distance = distance;
      truth.Volume =
        unit * unit * unit * (shape.Volume > 0.0 ? shape.Volume : MeasuredVolume(shape.Distance));
    }
    result.Shapes.push_back(truth);
  }
  return result;
}
} // namespace volumic::support
