// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SyntheticScenes.h"

#include "ForVoxels.h"
#include "SceneShapes.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace volumic::support
{
namespace
{

constexpr double Background = 20.0;
constexpr double Contrast = 100.0;
constexpr double ReferenceSize = 64.0;
// Minimum wall thickness is lambda delta = 1.44 * 0.85 voxels, plus a margin for the triangulation.
constexpr double ThinWall = 2.0;

/** Reproducible, unlike std::normal_distribution, with any standard library. */
class GaussianNoise
{
public:
  explicit GaussianNoise(unsigned int seed) : Generator(seed) {}

  double Next()
  {
    const double u = (this->Generator() + 1.0) / 4294967297.0;
    const double v = this->Generator() / 4294967296.0;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  }

private:
  std::mt19937 Generator;
};

/** Return the brightness at x in [0, 1]. */
double Shading(double x)
{
  return 1.25 - 0.5 * x;
}

} // namespace

Scene MakeScene(SceneKind kind, const SceneOptions& options)
{
  const double scale = *std::min_element(options.Size.begin(), options.Size.end()) / ReferenceSize;
  const SceneShape shape = MakeSceneShape(kind, ThinWall / scale);

  Scene scene;
  scene.Name = SceneName(kind);
  scene.Size = options.Size;
  scene.Spacing = options.Spacing;
  scene.ObjectIsBright = options.ObjectIsBright;
  scene.OneIsoValueFits = !shape.Shaded;
  scene.Components = shape.Components;
  scene.Genus = shape.Genus;
  scene.ComponentsFromOutside = shape.ComponentsFromOutside;
  scene.GenusFromOutside = shape.GenusFromOutside;
  scene.CoarsestFaithfulLevel = shape.CoarsestFaithfulLevel;
  scene.SeedRadius = shape.SeedRadius * scale;
  for (const std::array<double, 3>& seed : shape.Seeds)
  {
    std::array<double, 3> index;
    for (int a = 0; a < 3; ++a)
    {
      index[a] = 0.5 * (options.Size[a] - 1) + seed[a] * scale;
    }
    scene.Seeds.push_back(index);
  }

  // With shading, the dark end of the object is darker than the bright end of the background.
  const double background = shape.Shaded ? 0.9 * Contrast : Background;
  const double contrast = shape.Shaded ? 0.4 * Contrast : Contrast;
  scene.IsoValue = background + 0.5 * contrast;

  const std::size_t count = static_cast<std::size_t>(options.Size[0]) *
    static_cast<std::size_t>(options.Size[1]) * static_cast<std::size_t>(options.Size[2]);
  scene.Values.resize(count);
  scene.Inside.resize(count);
  GaussianNoise noise(options.NoiseSeed);
  const double blur = std::sqrt(0.5) / (0.5 * options.EdgeWidth);
  std::size_t voxel = 0;
  ForVoxels(options.Size,
    [&](int i, int j, int k)
    {
      const int index[3] = { i, j, k };
      std::array<double, 3> point;
      for (int a = 0; a < 3; ++a)
      {
        point[a] = (index[a] - 0.5 * (options.Size[a] - 1)) / scale;
      }
      const double distance = shape.Distance(point) * scale;
      const double occupied = 0.5 * std::erfc(distance * blur);
      const double fraction = options.ObjectIsBright ? occupied : 1.0 - occupied;
      double value = background + contrast * fraction;
      if (shape.Shaded)
      {
        value *= Shading(i / (options.Size[0] - 1.0));
      }
      if (options.NoiseShare > 0.0)
      {
        value += options.NoiseShare * contrast * noise.Next();
      }
      scene.Values[voxel] = static_cast<float>(value);
      scene.Inside[voxel] = distance < 0.0 ? 1 : 0;
      ++voxel;
    });
  return scene;
}

std::string SceneName(SceneKind kind)
{
  constexpr std::array<const char*, 11> names = { "Sphere", "TwoSpheres", "Torus",
    "BoxWithTwoTunnels", "ShellWithOpening", "NestedBalls", "ClosedNestedBalls",
    "ThinShellWithEightHoles", "FourBubbles", "TorusOfTwoBubbles", "ShadedEllipsoid" };
  return names.at(static_cast<std::size_t>(kind));
}

std::vector<SceneKind> SceneKindsReachableFromOutside()
{
  return { SceneKind::Sphere, SceneKind::TwoSpheres, SceneKind::Torus, SceneKind::BoxWithTwoTunnels,
    SceneKind::ShellWithOpening, SceneKind::NestedBalls, SceneKind::ThinShellWithEightHoles,
    SceneKind::FourBubbles, SceneKind::TorusOfTwoBubbles };
}
} // namespace volumic::support
