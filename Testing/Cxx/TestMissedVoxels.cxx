// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedVoxels.h"
#include "Core/Image/VoxelNumbers.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
/** More voxels in a row than bits in a word, more layers than a slab. */
constexpr int Size = 72;
constexpr double Centre = 35.6;
constexpr double Radius = 11.;

/** Random object voxels. */
TestVolume Noise(unsigned int percent)
{
  return MakeVolume(Size,
    [percent](double x, double y, double z)
    {
      auto hash = static_cast<std::uint32_t>(x + Size * (y + Size * z));
      for (const std::uint32_t factor : { 2654435761u, 2246822519u, 3266489917u })
      {
        hash = (hash ^ hash >> 15) * factor;
      }
      return (hash >> 8) % 100 < percent ? 1. : 0.;
    });
}

/** Mark the missed voxels by brute force. */
std::vector<std::uint8_t> Marks(const SurfaceState& state, const Field& field, PartKind kind)
{
  const VoxelNumbers numbers({ Size, Size, Size });
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(numbers.Count()), 0);
  for (std::int64_t voxel = 0; voxel < numbers.Count(); ++voxel)
  {
    const std::array<int, 3> p = numbers.IjkOf(voxel);
    const bool isObject = kind == PartKind::Object;
    const bool isInside = Distance(p[0], p[1], p[2], Centre, Centre, Centre) < Radius;
    marks[voxel] = isInside != isObject && (field.Voxel(p[0], p[1], p[2]) > 0) == isObject;
  }
  for (const Vector& v : state.Mesh.Position)
  {
    const auto first = [](float x) { return std::max(0, static_cast<int>(x - NearUnits)); };
    const auto end = [](float x) { return std::min(Size, static_cast<int>(x + NearUnits) + 1); };
    ForBox({ first(v.X), first(v.Y), first(v.Z) }, { end(v.X), end(v.Y), end(v.Z) },
      [&](int i, int j, int k)
      {
        if (Distance(i, j, k, v.X, v.Y, v.Z) <= NearUnits)
        {
          marks[numbers.Of(i, j, k)] = 0;
        }
      });
  }
  return marks;
}

using Parts = std::vector<std::vector<std::int64_t>>;

/** Return the face-connected components, in the order of their first voxels. */
Parts PartsOf(std::vector<std::uint8_t> marks, std::size_t minimumSize)
{
  const VoxelNumbers numbers({ Size, Size, Size });
  Parts all;
  for (std::int64_t first = 0; first < numbers.Count(); ++first)
  {
    std::vector<std::int64_t> part;
    const auto take = [&](std::int64_t voxel)
    {
      if (std::exchange(marks[static_cast<std::size_t>(voxel)], 0) != 0)
      {
        part.push_back(voxel);
      }
    };
    take(first);
    for (std::size_t n = 0; n < part.size(); ++n)
    {
      const std::array<int, 3> ijk = numbers.IjkOf(part[n]);
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::int64_t voxel = part[n];
        ijk[axis] > 0 ? take(voxel - numbers.Stride(axis)) : void();
        ijk[axis] + 1 < Size ? take(voxel + numbers.Stride(axis)) : void();
      }
    }
    if (!part.empty() && part.size() >= minimumSize)
    {
      std::sort(part.begin(), part.end());
      all.push_back(part);
    }
  }
  return all;
}

Parts PartsOf(const MissedVoxels& missed)
{
  Parts all(static_cast<std::size_t>(missed.Parts));
  for (const VoxelRun& run : missed.Runs)
  {
    for (int i = 0; i < run.Length; ++i)
    {
      all.at(static_cast<std::size_t>(run.Part)).push_back(run.First + i);
    }
  }
  return all;
}
}

TEST(MissedVoxels, EqualVoxelsAndPartsOfWholeImage)
{
  SurfaceState state;
  state.Mesh = MakeSphere({ Centre, Centre, Centre }, Radius, 1.2);
  state.Sizing = SizingField(0.85f);
  state.Reset(Vector(-2, -2, -2), Vector(Size + 2, Size + 2, Size + 2));
  Executor alone;
  Executor threads(3);
  const std::array<Executor*, 2> executors = { &alone, &threads };
  for (const unsigned int percent : { 3u, 28u, 34u, 60u, 97u })
  {
    const TestVolume volume = Noise(percent);
    const Field field(volume.Image, IsoHalf(), alone);
    for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
    {
      const std::vector<std::uint8_t> marks = Marks(state, field, kind);
      for (const int minimumSize : { 1, 2, 20 })
      {
        const Parts requested = PartsOf(marks, static_cast<std::size_t>(minimumSize));
        for (Executor* executor : executors)
        {
          const MissedVoxels missed =
            FindMissedVoxels(state, field, kind, minimumSize, *executor, NeverStop);
          EXPECT_EQ(PartsOf(missed), requested) << percent << " %, at least " << minimumSize;
        }
      }
    }
  }
}
