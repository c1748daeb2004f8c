// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedBoundary.h"

#include "Core/Common/Spans.h"
#include "Core/Image/VoxelNumbers.h"

#include <array>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
/** Mean ratio of the voxel faces of a smooth surface to its area, over all directions. */
constexpr double FacesOverArea = 1.5;
/** A part is missed if the surface lacks more than this fraction of its boundary. */
constexpr double MissedShare = 0.5;
/** Patches per span of a parallel loop. */
constexpr std::size_t PatchSpan = 256;
}

namespace
{
/** Return the area of the faces of a voxel between object and background. */
double BoundaryOf(const std::array<int, 3>& voxel, const Field& field, bool isObject)
{
  const LevelImage& image = field.Image();
  double area = 0.;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double face = image.Step[(axis + 1) % 3] * image.Step[(axis + 2) % 3];
    for (const int side : { -1, 1 })
    {
      std::array<int, 3> next = voxel;
      next[axis] += side;
      const bool isOutside = next[axis] < 0 || next[axis] >= image.Size[axis];
      const bool isOther =
        isOutside ? isObject : (field.Voxel(next[0], next[1], next[2]) > 0) != isObject;
      area += isOther ? face : 0.;
    }
  }
  return area;
}
}

void MissedBoundary::Add(
  const MissedVoxels& missed, const Field& field, PartKind kind, Executor& executor)
{
  const VoxelNumbers numbers(field.Image().Size);
  std::vector<std::vector<Patch>> spans(
    (missed.Runs.size() + MissedVoxels::RunSpan - 1) / MissedVoxels::RunSpan);
  ForSpans(executor, missed.Runs.size(), MissedVoxels::RunSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t r = begin; r < end; ++r)
      {
        const VoxelRun& run = missed.Runs[r];
        std::array<int, 3> voxel = numbers.IjkOf(run.First);
        for (int i = 0; i < run.Length; ++i, ++voxel[0])
        {
          const double area = BoundaryOf(voxel, field, kind == PartKind::Object);
          if (area > 0.)
          {
            spans[span].push_back(
              { run.First + i, static_cast<float>(area), this->Parts + run.Part });
          }
        }
      }
    });
  const std::vector<Patch> added = Joined(executor, spans);
  this->Patches.insert(this->Patches.end(), added.begin(), added.end());
  this->Parts += missed.Parts;
}

void MissedBoundary::Add(const MissedBoundary& other)
{
  for (const Patch& patch : other.Patches)
  {
    this->Patches.push_back({ patch.Voxel, patch.Area, this->Parts + patch.Part });
  }
  this->Parts += other.Parts;
}

std::vector<std::int64_t> MissedBoundary::Voxels() const
{
  std::vector<std::int64_t> voxels;
  for (const Patch& patch : this->Patches)
  {
    voxels.push_back(patch.Voxel);
  }
  return voxels;
}

std::vector<std::uint8_t> MissedBoundary::AreNear(
  const SurfaceState& state, const Field& field, Executor& executor) const
{
  const LevelImage& image = field.Image();
  const VoxelNumbers numbers(image.Size);
  const float reach = static_cast<float>(NearUnits * image.Unit);
  std::vector<std::uint8_t> areNear(this->Patches.size(), 0);
  ForSpans(executor, areNear.size(), PatchSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const std::array<int, 3> index = numbers.IjkOf(this->Patches[i].Voxel);
        const Vector position(static_cast<float>(index[0] * image.Step[0]),
          static_cast<float>(index[1] * image.Step[1]),
          static_cast<float>(index[2] * image.Step[2]));
        areNear[i] = state.Grid.HasWithin(position, reach, state.Mesh.Position);
      }
    });
  return areNear;
}

MissedBoundary::Missing MissedBoundary::MissedBy(
  const SurfaceState& state, double surfaceArea, const Field& field, Executor& executor) const
{
  const std::vector<std::uint8_t> areNear = this->AreNear(state, field, executor);
  std::vector<double> missed(static_cast<std::size_t>(this->Parts), 0.);
  std::vector<double> whole(static_cast<std::size_t>(this->Parts), 0.);
  for (std::size_t i = 0; i < this->Patches.size(); ++i)
  {
    missed[this->Patches[i].Part] += areNear[i] ? 0. : this->Patches[i].Area;
    whole[this->Patches[i].Part] += this->Patches[i].Area;
  }
  const double area = std::accumulate(missed.begin(), missed.end(), 0.) / FacesOverArea;
  Missing result;
  for (std::size_t part = 0; part < missed.size(); ++part)
  {
    result.Parts += missed[part] > MissedShare * whole[part];
  }
  result.Share = area > 0. ? area / (area + surfaceArea) : 0.;
  return result;
}
}
