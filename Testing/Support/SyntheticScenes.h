// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Synthetic volumes with known topology, used as acceptance scenes. SupportVtkConversions.h
 * converts them to vtkImageData. Lengths are in voxels, unless specified otherwise, with voxel
 * (0, 0, 0) at the origin.
 */

#ifndef volumicSyntheticScenes_h
#define volumicSyntheticScenes_h

#include <array>
#include <string>
#include <vector>

namespace volumic::support
{

/** Content of the volume. Components and genus refer to the isosurface. */
enum class SceneKind
{
  Sphere,            ///< one ball: 1 component, genus 0
  TwoSpheres,        ///< two balls: 2 components, a surface from outside must be cut
  Torus,             ///< tilted torus: genus 1, a surface from outside must be merged
  BoxWithTwoTunnels, ///< genus 2
  ShellWithOpening,  ///< a thick hollow ball with one opening: genus 0, but entered from outside
  NestedBalls,       ///< a ball in such a shell: 2 components, the ball reached through the opening
  ClosedNestedBalls, ///< without opening: 3 components, only the outer one reached from outside
  ThinShellWithEightHoles, ///< a wall of two voxels with eight holes: genus 7
  FourBubbles,             ///< a ball with four seeds that must merge: genus 0
  TorusOfTwoBubbles,       ///< a torus with two seeds that merge at both ends: genus 1
  ShadedEllipsoid          ///< shaded object and background: no iso-value fits
};

/** Sampling of a scene. */
struct SceneOptions
{
  /** Voxels along each axis. Shapes, except thin walls, scale with the smallest extent. */
  std::array<int, 3> Size = { 64, 64, 64 };
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 }; ///< world units per voxel
  bool ObjectIsBright = true;
  double EdgeWidth = 1.0; ///< twice the standard deviation of the Gaussian blur (partial volume)
  /** Standard deviation of the noise relative to the contrast. Reproducible for a NoiseSeed. */
  double NoiseShare = 0.0;
  unsigned int NoiseSeed = 1;
};

/** A volume and its expected segmentation. */
struct Scene
{
  std::string Name;
  std::array<int, 3> Size;
  std::array<double, 3> Spacing;
  std::vector<float> Values;         ///< Size[0] * Size[1] * Size[2], x fastest
  std::vector<unsigned char> Inside; ///< 1 for object voxels, before blur and noise

  double IsoValue = 0.0; ///< the middle between object and background
  bool ObjectIsBright = true;
  bool OneIsoValueFits = true; ///< false if some background is brighter than the object

  int Components = 1; ///< of the isosurface
  int Genus = 0;      ///< sum of all components
  /** Result of a surface that starts outside. Differs if there are closed cavities. */
  int ComponentsFromOutside = 1;
  int GenusFromOutside = 0;

  /** Seeds in the object, index coordinates. Empty if the object is too thin. */
  std::vector<std::array<double, 3>> Seeds;
  double SeedRadius = 0.0;

  /**
   * Coarsest level of a pyramid of factor sqrt 3 whose isosurface has the correct topology, for
   * 64^3 cubic voxels. Undefined if no iso-value fits.
   */
  int CoarsestFaithfulLevel = 0;
};

Scene MakeScene(SceneKind kind, const SceneOptions& options = SceneOptions());

/** Return the name of a kind, valid as test name. */
std::string SceneName(SceneKind kind);

/** Return the scenes that a surface from outside can segment completely. */
std::vector<SceneKind> SceneKindsReachableFromOutside();

} // namespace volumic::support

#endif
