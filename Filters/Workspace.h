// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Workspace_h
#define Workspace_h

#include "Core/SurfaceFeatures.h"

#include <array>

class vtkImageData;

namespace volumic
{
/**
 * The way between world coordinates and the workspace, in which voxels of level 0 are cubes of side
 * 1 and the first voxel is the origin (section 5.2 of the paper). Origin, spacing, direction and
 * extent of the image all count.
 */
class Workspace
{
public:
  Workspace() = default;

  /**
   * @param level0 the finest image
   * @throws std::invalid_argument if its voxels do not span a space (zero spacing, singular
   *         direction).
   */
  explicit Workspace(vtkImageData* level0);

  Point ToWorld(const Point& place) const;
  Point ToWorkspace(const Point& place) const;

  /// A normal of a surface: it stays perpendicular to it, and outward.
  std::array<float, 3> NormalToWorld(const std::array<float, 3>& normal) const;

  /// Whether a mirror is on the way, so that triangles must be turned round.
  bool IsMirrored() const { return this->Mirrored; }

  /// Smallest distance of two voxels of level 0, world units: what 1 stands for in the workspace.
  double WorldUnit() const { return this->Unit; }

private:
  using Matrix = std::array<double, 9>;
  Matrix Forward = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  Matrix Backward = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  Point Origin = { 0, 0, 0 };
  bool Mirrored = false;
  double Unit = 1;
};
}

#endif
