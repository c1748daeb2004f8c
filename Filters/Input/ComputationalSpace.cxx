// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ComputationalSpace.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Input/ImageVoxels.h"

#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkMatrix3x3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace volumic
{
ComputationalSpace::ComputationalSpace(vtkImageData* level0, Metric metric)
{
  const double* spacing = level0->GetSpacing();
  const double* direction = level0->GetDirectionMatrix()->GetData();
  const auto [least, most] =
    std::minmax({ std::abs(spacing[0]), std::abs(spacing[1]), std::abs(spacing[2]) });
  this->Unit = least;
  for (int axis = 0; axis < 3 && metric == Metric::World && this->Unit > 0.0; ++axis)
  {
    this->Steps[axis] = std::abs(spacing[axis]) / this->Unit;
  }
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      this->Forward[3 * row + column] =
        direction[3 * row + column] * spacing[column] / this->Steps[column];
    }
  }
  this->Origin = FirstVoxelOf(level0);
  const double determinant = vtkMatrix3x3::Determinant(this->Forward.data());
  // Floats must represent volumes, and doubles positions. The negations reject NaN, too.
  if (!(least >= 1e-12 && most <= std::min(1e12, 1000.0 * least) && std::abs(determinant) < 1e40 &&
        std::abs(determinant) > 1e-6 * std::pow(least, 3.0)))
  {
    ThrowInvalidArgument("the spacing of the image is ", spacing[0], " x ", spacing[1], " x ",
      spacing[2],
      ", or its direction matrix is singular. Set the spacing to the distances of the "
      "voxels, from 1e-12 to 1e12, and to at most 1000 times the smallest.");
  }
  if (!(std::hypot(this->Origin[0], this->Origin[1], this->Origin[2]) <= 1e10 * least))
  {
    ThrowInvalidArgument(
      "the first voxel is more than 1e10 voxels from 0. Move the origin nearer.");
  }
  vtkMatrix3x3::Invert(this->Forward.data(), this->Backward.data());
  this->Mirrored = determinant < 0.0;
}

Point ComputationalSpace::ToWorld(const Point& position) const
{
  Point world;
  for (int row = 0; row < 3; ++row)
  {
    const double* m = &this->Forward[3 * row];
    world[row] = this->Origin[row] + m[0] * position[0] + m[1] * position[1] + m[2] * position[2];
  }
  return world;
}

Point ComputationalSpace::ToComputationalSpace(const Point& world) const
{
  const double d[3] = { world[0] - this->Origin[0], world[1] - this->Origin[1],
    world[2] - this->Origin[2] };
  Point position;
  for (int row = 0; row < 3; ++row)
  {
    const double* m = &this->Backward[3 * row];
    position[row] = m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
  }
  return position;
}

std::array<float, 3> ComputationalSpace::NormalToWorld(const std::array<float, 3>& normal) const
{
  // Normals are transformed by the transposed inverse.
  double world[3];
  for (int column = 0; column < 3; ++column)
  {
    world[column] = this->Backward[column] * normal[0] + this->Backward[3 + column] * normal[1] +
      this->Backward[6 + column] * normal[2];
  }
  vtkMath::Normalize(world);
  return { static_cast<float>(world[0]), static_cast<float>(world[1]),
    static_cast<float>(world[2]) };
}

namespace
{
constexpr std::size_t PointSpan = 16384;

template <typename Map>
IndexedSurface Transform(
  IndexedSurface surface, const ComputationalSpace& space, Executor& executor, const Map& map)
{
  ForSpans(executor, surface.Points.size(), PointSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        surface.Points[p] = map(surface.Points[p]);
      }
    });
  if (space.IsMirrored())
  {
    for (auto& triangle : surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return surface;
}
}

IndexedSurface ToWorld(IndexedSurface surface, const ComputationalSpace& space, Executor& executor)
{
  return Transform(std::move(surface), space, executor,
    [&space](const Point& position) { return space.ToWorld(position); });
}

IndexedSurface ToComputationalSpace(IndexedSurface surface, const ComputationalSpace& space)
{
  return Transform(std::move(surface), space, OnThisThread(),
    [&space](const Point& world) { return space.ToComputationalSpace(world); });
}
}
