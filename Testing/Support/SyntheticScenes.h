// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Synthetic volumes of 64^3 voxels with known topology, used as acceptance scenes.
 * SupportVtkConversions.h converts them to vtkImageData. Lengths are in voxels, unless specified
 * otherwise, with voxel (0, 0, 0) at the origin.
 */

#ifndef volumicSyntheticScenes_h
#define volumicSyntheticScenes_h

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace volumic::support
{

/** Content of the volume. Components and genus refer to the isosurface. */
enum class SceneKind
{
  Sphere,            ///< one ball, with four seeds that must merge: 1 component, genus 0
  TwoSpheres,        ///< two balls: 2 components, a surface from outside must be cut
  Torus,             ///< tilted: genus 1, a surface from outside or two seeds must be merged
  BoxWithTwoTunnels, ///< genus 2
  ShellWithOpening,  ///< a thick hollow ball with one opening: genus 0, but entered from outside
  NestedBalls,       ///< a ball in such a shell: 2 components, the ball reached through the opening
  ThinShellWithEightHoles, ///< a wall of two voxels with eight holes: genus 7
  ShadedEllipsoid          ///< shaded object and background: no iso-value fits
};

/** Return the name of a kind, valid as test name. */
std::string SceneName(SceneKind kind);

/** Return the signed distance from a shape around 0, negative inside, accurate near its surface. */
std::function<double(const std::array<double, 3>&)> DistanceOf(SceneKind kind);

/** Sampling of a scene. */
struct SceneOptions
{
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 }; ///< world units per voxel
  bool ObjectIsBright = true;
  /** Standard deviation of the noise relative to the contrast. Reproducible for a NoiseSeed. */
  double NoiseShare = 0.0;
  unsigned int NoiseSeed = 1;
};

/** A volume and its expected segmentation. */
struct Scene
{
  std::array<int, 3> Size = { 64, 64, 64 };
  std::array<double, 3> Spacing;
  std::vector<float> Values;         ///< Size[0] * Size[1] * Size[2], x fastest
  std::vector<unsigned char> Inside; ///< 1 for object voxels, before blur and noise

  double IsoValue = 0.0; ///< the middle between object and background
  bool ObjectIsBright = true;
  int Components = 1;
  int Genus = 0; ///< sum of all components

  /** Seeds in the object, index coordinates. Empty for scenes that start outside only. */
  std::vector<std::array<double, 3>> Seeds;
  double SeedRadius = 0.0;

  /** Coarsest level of a pyramid of factor sqrt 3 whose isosurface has the correct topology, for
      cubic voxels. Undefined if no iso-value fits. */
  int CoarsestFaithfulLevel = 0;
};

Scene MakeScene(SceneKind kind, const SceneOptions& options = SceneOptions());

} // namespace volumic::support

#endif
