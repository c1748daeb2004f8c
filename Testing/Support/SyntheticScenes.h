// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Volumes made by formula, whose segmentation has a known number of components and a known genus.
 *
 * They are the acceptance scenes of the deformable surface, and inputs for every other test and
 * benchmark that wants a volume whose content is known. No VTK in here; SupportVtkConversions.h
 * turns a scene into a vtkImageData.
 *
 * Lengths are in voxels unless said otherwise. Index coordinates are (i, j, k) with voxel (0, 0, 0)
 * at the origin; world = origin + direction * (spacing * index) is left to the user of the scene.
 */

#ifndef volumicSyntheticScenes_h
#define volumicSyntheticScenes_h

#include <array>
#include <string>
#include <vector>

namespace volumic::support
{

/** What is in the volume. Counts are those of the iso-surface; see Scene for the details. */
enum class SceneKind
{
  Sphere,            ///< one ball: 1 component, genus 0
  TwoSpheres,        ///< two balls apart: 2 components; a surface from outside has to be cut
  Torus,             ///< a tilted ring: genus 1; a surface from outside has to close the hole
  BoxWithTwoTunnels, ///< genus 2
  ShellWithOpening,  ///< a thick hollow ball with one opening: genus 0, but entered from outside
  NestedBalls,       ///< a ball inside such a shell: 2 components, the inner one found through the
                     ///< opening only
  ClosedNestedBalls, ///< the same without an opening: 3 components, one of which (the outside of
                     ///< the shell) can be reached from outside; the second bounds a cavity
  ThinShellWithEightHoles, ///< a wall of two voxels with eight holes: genus 7
  FourBubbles,             ///< a ball, with four seeds in it that have to merge: genus 0
  TorusOfTwoBubbles,       ///< a ring, with two seeds in it that merge at both ends: genus 1
  ShadedEllipsoid          ///< object and background both shaded, so that no iso-value fits
};

/** How a scene is sampled. */
struct SceneOptions
{
  /**
   * Voxels along each axis. Shapes scale with the smallest extent; walls said to be thin do not.
   */
  std::array<int, 3> Size = { 64, 64, 64 };

  /** World units per voxel. */
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };

  /** The object is bright on a dark background, or the other way round. */
  bool ObjectIsBright = true;

  /**
   * Width of an edge: a step blurred by a Gaussian of half of this as standard deviation, which is
   * what the partial volume effect makes of it. Iso-surfaces at the middle stay where they are.
   */
  double EdgeWidth = 1.0;

  /**
   * Standard deviation of white Gaussian noise, as a share of the contrast. Values are the same on
   * every machine for the same NoiseSeed.
   */
  double NoiseShare = 0.0;
  unsigned int NoiseSeed = 1;
};

/** A volume and what has to be found in it. */
struct Scene
{
  std::string Name;
  std::array<int, 3> Size;
  std::array<double, 3> Spacing;
  std::vector<float> Values; ///< Size[0] * Size[1] * Size[2], x fastest
  std::vector<unsigned char>
    Inside; ///< 1 where the voxel lies in the object, before blur and noise

  double IsoValue = 0.0; ///< the middle between object and background
  bool ObjectIsBright = true;
  /**
   * False where the background is partly brighter than the object; IsoValue is then the middle at
   * the centre of the volume.
   */
  bool OneIsoValueFits = true;

  int Components = 1; ///< of the whole iso-surface
  int Genus = 0;      ///< of all of its components together
  /** What a surface that starts outside ends with. It differs where there are closed cavities. */
  int ComponentsFromOutside = 1;
  int GenusFromOutside = 0;

  /**
   * Places inside the object from which it can be filled, index coordinates. Empty where the
   * object is too thin to hold a seed.
   */
  std::vector<std::array<double, 3>> Seeds;
  double SeedRadius = 0.0;

  /**
   * Coarsest level of a pyramid of factor sqrt 3 whose iso-surface still has the right components
   * and genus, at a size of 64^3 with cubic voxels. A run that starts from a coarser level has to
   * recover what vanished there. Means nothing where no iso-value fits.
   */
  int CoarsestFaithfulLevel = 0;
};

/** Makes a scene. */
Scene MakeScene(SceneKind kind, const SceneOptions& options = SceneOptions());

/** The name that MakeScene gives, usable in the name of a test (letters only). */
std::string SceneName(SceneKind kind);

/**
 * Without the shaded one and the one with a closed cavity: those that a surface which starts
 * outside has to segment completely.
 */
std::vector<SceneKind> SceneKindsReachableFromOutside();

} // namespace volumic::support

#endif
