// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SceneShapes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace volumic::support
{
namespace
{

using Vector = std::array<double, 3>;

// Radius of rounded convex edges: a mesh with edges of about a voxel cannot resolve less.
constexpr double EdgeRounding = 2.0;

// Signed distances (negative inside), accurate near the surface.

double Dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double Length(const Vector& a)
{
  return std::sqrt(Dot(a, a));
}

Vector Scaled(const Vector& a, double factor)
{
  return { a[0] * factor, a[1] * factor, a[2] * factor };
}

Vector Minus(const Vector& a, const Vector& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector Unit(const Vector& a)
{
  return Scaled(a, 1.0 / Length(a));
}

double Ball(const Vector& p, const Vector& centre, double radius)
{
  return Length(Minus(p, centre)) - radius;
}

double Ring(const Vector& p, const Vector& axis, double major, double minor)
{
  const double height = Dot(p, axis);
  const double around = std::sqrt(std::max(0.0, Dot(p, p) - height * height));
  return std::hypot(around - major, height) - minor;
}

double RoundedBox(const Vector& p, const Vector& halfSize, double rounding)
{
  Vector outside;
  double largest = -1e30;
  for (int a = 0; a < 3; ++a)
  {
    const double q = std::abs(p[a]) - halfSize[a] + rounding;
    outside[a] = std::max(q, 0.0);
    largest = std::max(largest, q);
  }
  return Length(outside) + std::min(largest, 0.0) - rounding;
}

double Capsule(const Vector& p, const Vector& from, const Vector& to, double radius)
{
  const Vector along = Minus(to, from);
  const double t = std::clamp(Dot(Minus(p, from), along) / Dot(along, along), 0.0, 1.0);
  return Length(Minus(Minus(p, from), Scaled(along, t))) - radius;
}

double Ellipsoid(const Vector& p, const Vector& semiAxes)
{
  Vector q, gradient;
  for (int a = 0; a < 3; ++a)
  {
    q[a] = p[a] / semiAxes[a];
    gradient[a] = q[a] / semiAxes[a];
  }
  const double norm = Length(gradient);
  const double level = Length(q);
  return norm > 0.0 ? level * (level - 1.0) / norm : -semiAxes[0];
}

/** Difference of `a` and `b`, with rounded edges. */
double Without(double a, double b, double rounding)
{
  const double h = std::max(rounding - std::abs(a + b), 0.0) / rounding;
  return std::max(a, -b) + 0.25 * h * h * rounding;
}

// Shapes are not aligned with the voxels.
const Vector TiltedAxis = Unit({ 0.3, 0.5, 0.81 });

SceneShape MakeSphere()
{
  SceneShape shape;
  shape.Distance = [](const Vector& p) { return Ball(p, { 0.7, -0.4, 0.3 }, 20.0); };
  shape.Seeds = { { 0.0, 0.0, 0.0 } };
  shape.SeedRadius = 6.0;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeTwoSpheres()
{
  const Vector centre = { 14.0, 5.0, -4.0 };
  SceneShape shape;
  shape.Distance = [centre](const Vector& p)
  { return std::min(Ball(p, centre, 11.0), Ball(p, Scaled(centre, -1.0), 11.0)); };
  shape.Components = shape.ComponentsFromOutside = 2;
  shape.Seeds = { centre, Scaled(centre, -1.0) };
  shape.SeedRadius = 5.0;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeTorus(const Vector& axis)
{
  const double major = 17.0;
  SceneShape shape;
  shape.Distance = [axis, major](const Vector& p) { return Ring(p, axis, major, 7.5); };
  shape.Genus = shape.GenusFromOutside = 1;
  const Vector across = Unit(Minus({ 1.0, 0.0, 0.0 }, Scaled(axis, axis[0])));
  shape.Seeds = { Scaled(across, major), Scaled(across, -major) };
  shape.SeedRadius = 4.0;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeBoxWithTwoTunnels()
{
  SceneShape shape;
  shape.Distance = [](const Vector& p)
  {
    const double box = RoundedBox(p, { 26.0, 16.0, 13.0 }, 4.0);
    const double left = Capsule(p, { -11.0, -3.0, -40.0 }, { -11.0, 3.0, 40.0 }, 6.0);
    const double right = Capsule(p, { 11.0, 3.0, -40.0 }, { 11.0, -3.0, 40.0 }, 6.0);
    return Without(box, std::min(left, right), EdgeRounding);
  };
  shape.Genus = shape.GenusFromOutside = 2;
  shape.Seeds = { { 0.0, 0.0, 0.0 }, { -21.5, 0.0, 0.0 }, { 21.5, 0.0, 0.0 } };
  shape.SeedRadius = 3.5;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

/** Hollow ball with a tubular opening; radius 0: closed. */
double OpenedShell(const Vector& p, double outer, double inner, double opening)
{
  const double radius = Length(p);
  const double shell = std::max(radius - outer, inner - radius);
  return opening > 0.0
    ? Without(shell, Capsule(p, { 0.0, 0.0, 0.0 }, Scaled(TiltedAxis, 60.0), opening), EdgeRounding)
    : shell;
}

SceneShape MakeShellWithOpening()
{
  SceneShape shape;
  shape.Distance = [](const Vector& p) { return OpenedShell(p, 26.0, 17.5, 8.0); };
  shape.Seeds = { Scaled(TiltedAxis, -21.7) };
  shape.SeedRadius = 3.5;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeNestedBalls(bool opened)
{
  const double opening = opened ? 9.5 : 0.0;
  SceneShape shape;
  shape.Distance = [opening](const Vector& p)
  { return std::min(OpenedShell(p, 28.0, 19.5, opening), Ball(p, Scaled(TiltedAxis, -0.5), 8.0)); };
  shape.Components = opened ? 2 : 3;
  shape.ComponentsFromOutside = opened ? 2 : 1;
  shape.Seeds = { { 0.0, 0.0, 0.0 }, Scaled(TiltedAxis, -23.7) };
  shape.SeedRadius = 3.0;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeThinShellWithEightHoles(double wall)
{
  SceneShape shape;
  shape.Distance = [wall](const Vector& p)
  {
    const double shell = std::abs(Length(p) - 22.0) - 0.5 * wall;
    // Holes at the corners of a cube rotated about z.
    const double c = std::cos(0.35), s = std::sin(0.35);
    const Vector turned = { std::abs(c * p[0] - s * p[1]), std::abs(s * p[0] + c * p[1]),
      std::abs(p[2]) };
    const double hole = Capsule(turned, { 0.0, 0.0, 0.0 }, { 40.0, 40.0, 40.0 }, 6.0);
    return Without(shell, hole, 0.5 * EdgeRounding);
  };
  shape.Genus = shape.GenusFromOutside = 7;
  shape.CoarsestFaithfulLevel = 0;
  return shape;
}

SceneShape MakeFourBubbles()
{
  SceneShape shape;
  shape.Distance = [](const Vector& p) { return Ball(p, { 0.2, 0.3, -0.4 }, 21.0); };
  shape.Seeds = { { 8.0, 8.0, 8.0 }, { 8.0, -8.0, -8.0 }, { -8.0, 8.0, -8.0 },
    { -8.0, -8.0, 8.0 } };
  shape.SeedRadius = 5.0;
  shape.CoarsestFaithfulLevel = 3;
  return shape;
}

SceneShape MakeShadedEllipsoid()
{
  SceneShape shape;
  shape.Distance = [](const Vector& p) { return Ellipsoid(p, { 25.0, 15.0, 13.0 }); };
  shape.Seeds = { { 0.0, 0.0, 0.0 } };
  shape.SeedRadius = 6.0;
  shape.Shaded = true;
  return shape;
}

} // namespace

SceneShape MakeSceneShape(SceneKind kind, double thinWall)
{
  switch (kind)
  {
    case SceneKind::Sphere:
      return MakeSphere();
    case SceneKind::TwoSpheres:
      return MakeTwoSpheres();
    case SceneKind::Torus:
      return MakeTorus(TiltedAxis);
    case SceneKind::BoxWithTwoTunnels:
      return MakeBoxWithTwoTunnels();
    case SceneKind::ShellWithOpening:
      return MakeShellWithOpening();
    case SceneKind::NestedBalls:
      return MakeNestedBalls(true);
    case SceneKind::ClosedNestedBalls:
      return MakeNestedBalls(false);
    case SceneKind::ThinShellWithEightHoles:
      return MakeThinShellWithEightHoles(thinWall);
    case SceneKind::FourBubbles:
      return MakeFourBubbles();
    case SceneKind::TorusOfTwoBubbles:
      return MakeTorus(Unit({ -0.2, 0.9, 0.35 }));
    case SceneKind::ShadedEllipsoid:
      return MakeShadedEllipsoid();
  }
  throw std::invalid_argument("MakeScene: unknown kind of scene");
}

} // namespace volumic::support
