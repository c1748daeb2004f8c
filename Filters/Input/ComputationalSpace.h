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
/** Space in which the constraints on lengths hold (section 5.2 of the paper). */
enum class Metric
{
  Voxels = 0, ///< affine space in which voxels are cubes
  World = 1   ///< world space, rotated and scaled uniformly
};

/**
 * Transformation between world coordinates and the computational space. That space has the axes of
 * the image and the first voxel as its origin. The smallest voxel spacing of level 0 is 1. The
 * other spacings are 1 with Metric::Voxels, and keep their ratio with Metric::World. Origin,
 * spacing, direction and extent of the image are applied. A direction matrix that is not
 * orthonormal shears the lengths of Metric::World, too.
 */
class ComputationalSpace
{
public:
  ComputationalSpace() = default;

  /**
   * @param level0 the finest image
   * @throws InvalidArgument if the spacing, direction or origin is out of range
   */
  ComputationalSpace(vtkImageData* level0, Metric metric);

  Point ToWorld(const Point& position) const;
  Point ToComputationalSpace(const Point& world) const;

  /** Return the unit normal in world coordinates, perpendicular to the surface and outward. */
  std::array<float, 3> NormalToWorld(const std::array<float, 3>& normal) const;

  /** Return whether the transformation flips the orientation of triangles. */
  bool IsMirrored() const { return this->Mirrored; }

  /** Return length 1 of the computational space in world units: the smallest spacing of level 0. */
  double WorldUnit() const { return this->Unit; }

  /** Return the voxel spacing of level 0 in computational space, at least 1. */
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

/** Transform a surface. It stays oriented outward. A moved surface is transformed in place. */
IndexedSurface ToWorld(IndexedSurface surface, const ComputationalSpace& space, Executor& executor);

IndexedSurface ToComputationalSpace(IndexedSurface surface, const ComputationalSpace& space);
}

#endif
