// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SyntheticScenes.h"

#include "ForVoxels.h"
#include "JudgeInternals.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace volumic::support
{
namespace
{

using Vector = std::array<double, 3>;

constexpr double Background = 20.0;
constexpr double Contrast = 100.0;
// Radius of rounded convex edges: a mesh with edges of about a voxel cannot resolve less.
constexpr double EdgeRounding = 2.0;
// Minimum wall thickness is lambda delta = 1.44 * 0.85 voxels, plus a margin for the triangulation.
constexpr double ThinWall = 2.0;

Vector Scaled(const Vector& a, double factor)
{
  return { a[0] * factor, a[1] * factor, a[2] * factor };
}

// Shapes are not aligned with the voxels.
const Vector TiltedAxis = Scaled({ 0.3, 0.5, 0.81 }, 1.0 / Norm({ 0.3, 0.5, 0.81 }));
const Vector BallCentre = { 14.0, 5.0, -4.0 }; // and opposite
constexpr double MajorRadius = 17.0;

// Signed distances (negative inside), accurate near the surface.

double Ball(const Vector& p, const Vector& centre, double radius)
{
  return Norm(Difference(p, centre)) - radius;
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
  return Norm(outside) + std::min(largest, 0.0) - rounding;
}

double Capsule(const Vector& p, const Vector& from, const Vector& to, double radius)
{
  const Vector along = Difference(to, from);
  const double t = std::clamp(Dot(Difference(p, from), along) / Dot(along, along), 0.0, 1.0);
  return Norm(Difference(Difference(p, from), Scaled(along, t))) - radius;
}

/** Difference of `a` and `b`, with rounded edges. */
double Without(double a, double b, double rounding)
{
  const double h = std::max(rounding - std::abs(a + b), 0.0) / rounding;
  return std::max(a, -b) + 0.25 * h * h * rounding;
}

double Sphere(const Vector& p)
{
  return Ball(p, { 0.7, -0.4, 0.3 }, 20.0);
}

double TwoSpheres(const Vector& p)
{
  return std::min(Ball(p, BallCentre, 11.0), Ball(p, Scaled(BallCentre, -1.0), 11.0));
}

double Torus(const Vector& p)
{
  const double height = Dot(p, TiltedAxis);
  const double around = std::sqrt(std::max(0.0, Dot(p, p) - height * height));
  return std::hypot(around - MajorRadius, height) - 7.5;
}

double BoxWithTwoTunnels(const Vector& p)
{
  const double box = RoundedBox(p, { 26.0, 16.0, 13.0 }, 4.0);
  const double left = Capsule(p, { -11.0, -3.0, -40.0 }, { -11.0, 3.0, 40.0 }, 6.0);
  const double right = Capsule(p, { 11.0, 3.0, -40.0 }, { 11.0, -3.0, 40.0 }, 6.0);
  return Without(box, std::min(left, right), EdgeRounding);
}

/** Hollow ball with a tubular opening. */
double OpenedShell(const Vector& p, double outer, double inner, double opening)
{
  const double radius = Norm(p);
  const double shell = std::max(radius - outer, inner - radius);
  return Without(
    shell, Capsule(p, { 0.0, 0.0, 0.0 }, Scaled(TiltedAxis, 60.0), opening), EdgeRounding);
}

double ShellWithOpening(const Vector& p)
{
  return OpenedShell(p, 26.0, 17.5, 8.0);
}

double NestedBalls(const Vector& p)
{
  return std::min(OpenedShell(p, 28.0, 19.5, 9.5), Ball(p, Scaled(TiltedAxis, -0.5), 8.0));
}

double ThinShellWithEightHoles(const Vector& p)
{
  const double shell = std::abs(Norm(p) - 22.0) - 0.5 * ThinWall;
  // Holes at the corners of a cube rotated about z.
  const double c = std::cos(0.35), s = std::sin(0.35);
  const Vector turned = { std::abs(c * p[0] - s * p[1]), std::abs(s * p[0] + c * p[1]),
    std::abs(p[2]) };
  const double hole = Capsule(turned, { 0.0, 0.0, 0.0 }, { 40.0, 40.0, 40.0 }, 6.0);
  return Without(shell, hole, 0.5 * EdgeRounding);
}

double ShadedEllipsoid(const Vector& p)
{
  const Vector semiAxes = { 25.0, 15.0, 13.0 };
  Vector q, gradient;
  for (int a = 0; a < 3; ++a)
  {
    q[a] = p[a] / semiAxes[a];
    gradient[a] = q[a] / semiAxes[a];
  }
  const double norm = Norm(gradient);
  const double level = Norm(q);
  return norm > 0.0 ? level * (level - 1.0) / norm : -semiAxes[0];
}

/** A shape around 0 and the facts of its scene. */
struct SceneShape
{
  const char* Name;
  double (*Distance)(const Vector&);
  int Components = 1;
  int Genus = 0;
  int CoarsestFaithfulLevel = 3;
  std::vector<Vector> Seeds = {};
  double SeedRadius = 0.0;
};

const SceneShape& ShapeOf(SceneKind kind)
{
  const Vector across = Difference({ 1.0, 0.0, 0.0 }, Scaled(TiltedAxis, TiltedAxis[0]));
  const Vector inRing = Scaled(across, MajorRadius / Norm(across));
  const std::vector<Vector> inBall = { { 8.0, 8.0, 8.0 }, { 8.0, -8.0, -8.0 }, { -8.0, 8.0, -8.0 },
    { -8.0, -8.0, 8.0 } };
  static const SceneShape shapes[] = { { "Sphere", Sphere, 1, 0, 3, inBall, 5.0 },
    { "TwoSpheres", TwoSpheres, 2 },
    { "Torus", Torus, 1, 1, 3, { inRing, Scaled(inRing, -1.0) }, 4.0 },
    { "BoxWithTwoTunnels", BoxWithTwoTunnels, 1, 2 },
    { "ShellWithOpening", ShellWithOpening, 1, 0, 3, { Scaled(TiltedAxis, -21.7) }, 3.5 },
    { "NestedBalls", NestedBalls, 2 },
    { "ThinShellWithEightHoles", ThinShellWithEightHoles, 1, 7, 0 },
    { "ShadedEllipsoid", ShadedEllipsoid } };
  return shapes[static_cast<std::size_t>(kind)];
}

} // namespace

std::string SceneName(SceneKind kind)
{
  return ShapeOf(kind).Name;
}

std::function<double(const Vector&)> DistanceOf(SceneKind kind)
{
  return ShapeOf(kind).Distance;
}

Scene MakeScene(SceneKind kind, const SceneOptions& options)
{
  const SceneShape& shape = ShapeOf(kind);
  Scene scene;
  scene.Spacing = options.Spacing;
  scene.ObjectIsBright = options.ObjectIsBright;
  scene.Components = shape.Components;
  scene.Genus = shape.Genus;
  scene.CoarsestFaithfulLevel = shape.CoarsestFaithfulLevel;
  scene.SeedRadius = shape.SeedRadius;
  const Vector middle = { 31.5, 31.5, 31.5 };
  for (const Vector& seed : shape.Seeds)
  {
    scene.Seeds.push_back(Difference(middle, Scaled(seed, -1.0)));
  }

  // With shading, the dark end of the object is darker than the bright end of the background.
  const bool isShaded = kind == SceneKind::ShadedEllipsoid;
  const double background = isShaded ? 0.9 * Contrast : Background;
  const double contrast = isShaded ? 0.4 * Contrast : Contrast;
  scene.IsoValue = background + 0.5 * contrast;

  // Gaussian noise that is reproducible with any standard library.
  std::mt19937 generator(options.NoiseSeed);
  const auto noise = [&]
  {
    const double u = (generator() + 1.0) / 4294967297.0;
    const double v = generator() / 4294967296.0;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  };
  const double blur = std::sqrt(0.5) / 0.5; // The standard deviation of the partial volume is 0.5.
  ForVoxels(scene.Size,
    [&](int i, int j, int k)
    {
      const double distance = shape.Distance({ i - middle[0], j - middle[1], k - middle[2] });
      const double occupied = 0.5 * std::erfc(distance * blur);
      const double fraction = options.ObjectIsBright ? occupied : 1.0 - occupied;
      double value = background + contrast * fraction;
      if (isShaded)
      {
        value *= 1.25 - 0.5 * (i / (scene.Size[0] - 1.0));
      }
      if (options.NoiseShare > 0.0)
      {
        value += options.NoiseShare * contrast * noise();
      }
      scene.Values.push_back(static_cast<float>(value));
      scene.Inside.push_back(distance < 0.0 ? 1 : 0);
    });
  return scene;
}

} // namespace volumic::support
