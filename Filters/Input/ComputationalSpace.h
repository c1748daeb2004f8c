// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComputationalSpace_h
#define volumicComputationalSpace_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <array>

class vtkImageData;

namespace volumic
{
/** Which lengths the constraints of the surface speak of (section 5.2 of the paper). */
enum class Metric
{
  Voxels = 0, ///< An affine space in which voxels are cubes: the workspace is stretched.
  World = 1   ///< World lengths: the workspace is the world, turned and scaled alike.
};

/**
 * The way between world coordinates and the workspace, whose axes are those of the image, whose
 * origin is the first voxel, and in which the smallest voxel distance of level 0 is 1. By
 * Metric::Voxels the other distances are 1 as well, by Metric::World they keep their ratio. Origin,
 * spacing, direction and extent of the image all count. A direction matrix that is not orthonormal
 * (no format of files has one) shears World lengths, too.
 */
class ComputationalSpace
{
public:
  ComputationalSpace() = default;

  /**
   * @param level0 the finest image
   * @throws std::invalid_argument if its voxels do not span a space (zero spacing, singular
   *         direction).
   */
  ComputationalSpace(vtkImageData* level0, Metric metric);

  Point ToWorld(const Point& place) const;
  Point ToComputationalSpace(const Point& place) const;

  /** A normal of a surface: it stays perpendicular to it, and outward. */
  std::array<float, 3> NormalToWorld(const std::array<float, 3>& normal) const;

  /** Whether a mirror is on the way, so that the orientation of triangles must be flipped. */
  bool IsMirrored() const { return this->Mirrored; }

  /**
   * Smallest distance of two voxels of level 0, world units: what 1 stands for in the workspace.
   */
  double WorldUnit() const { return this->Unit; }

  /** Distance of two voxels of level 0 along each axis of the image, workspace; at least 1. */
  const std::array<double, 3>& Step() const { return this->Steps; }

private:
  using Matrix = std::array<double, 9>;
  Matrix Forward = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  Matrix Backward = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  Point Origin = { 0, 0, 0 };
  std::array<double, 3> Steps = { 1, 1, 1 };
  bool Mirrored = false;
  double Unit = 1;
};

/** The surface in world coordinates, outward oriented there; in its place if it is given up. */
IndexedSurface ToWorld(IndexedSurface surface, const ComputationalSpace& space, Executor& executor);

/** The surface in the workspace, outward oriented there; in its place if it is given up. */
IndexedSurface ToComputationalSpace(IndexedSurface surface, const ComputationalSpace& space);
}

#endif
