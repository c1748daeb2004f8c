// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelScenes_h
#define volumicVoxelScenes_h

#include "Core/Interfaces/DualMesh.h"
#include "Core/Mesh/SelfIntersections.h"
#include "SurfaceTopology.h"
#include "VoxelTopology.h"

#include <sstream>
#include <tuple>

/** Label maps and tests of their meshes. */
namespace volumic
{
using Voxel = VoxelTopology::Voxel;

/** Labels in a box whose outermost layer is background. */
struct VoxelScene
{
  Voxel Size;
  std::vector<int> Labels; ///< x fastest
  std::vector<int> RankOf;
  std::array<double, 3> Spacing = { 1., 1., 1. };
  int Outside = -1;

  /** Create inner voxels and a layer around them. Ranks: fewest voxels first, background last. */
  template <typename LabelAt>
  VoxelScene(const Voxel& inner, LabelAt&& labelAt, int outside = -1)
    : Size({ inner[0] + 2, inner[1] + 2, inner[2] + 2 }), Outside(outside)
  {
    ForVoxels(this->Size,
      [&](int i, int j, int k)
      {
        const bool isIn =
          i > 0 && j > 0 && k > 0 && i <= inner[0] && j <= inner[1] && k <= inner[2];
        this->Labels.push_back(isIn ? labelAt(i - 1, j - 1, k - 1) : std::max(outside, 0));
      });
    this->RankByCount();
  }

  int NumberOfLabels() const
  {
    return 1 + *std::max_element(this->Labels.begin(), this->Labels.end());
  }

  void RankByCount()
  {
    std::vector<long long> counts(static_cast<std::size_t>(this->NumberOfLabels()), 0);
    for (const int label : this->Labels)
    {
      ++counts[static_cast<std::size_t>(label)];
    }
    std::vector<int> order(counts.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int label)
    {
      return std::make_tuple(
        label == this->Outside, label == 0, counts[static_cast<std::size_t>(label)]);
    };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
    this->RankInOrder(order);
  }
  void RankAtRandom(unsigned seed)
  {
    std::vector<int> order(this->RankOf.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    this->RankInOrder(order);
  }
  void RankInOrder(const std::vector<int>& order)
  {
    this->RankOf.resize(order.size());
    for (std::size_t n = 0; n < order.size(); ++n)
    {
      this->RankOf[static_cast<std::size_t>(order[n])] = static_cast<int>(n);
    }
  }

  int At(int i, int j, int k) const
  {
    return this->Labels[static_cast<std::size_t>(i + this->Size[0] * (j + this->Size[1] * k))];
  }
  VoxelTopology Voxels() const { return { this->Size, this->Labels, this->RankOf }; }

  DualGrid Grid() const
  {
    DualGrid grid;
    grid.Size = this->Size;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int n = 0; n < this->Size[axis]; ++n)
      {
        grid.Centres[axis].push_back(static_cast<float>(n * this->Spacing[axis]));
        grid.Planes[axis].push_back(static_cast<float>((n + .5) * this->Spacing[axis]));
      }
      grid.Planes[axis].pop_back();
    }
    grid.RankOf = this->RankOf;
    grid.Outside = this->Outside;
    grid.CopySlice = [this](int k, LabelMap::Number* labels)
    {
      const std::ptrdiff_t count = this->Size[0] * this->Size[1];
      const auto first = this->Labels.begin() + k * count;
      std::transform(first, first + count, labels,
        [](int label) { return static_cast<LabelMap::Number>(label); });
    };
    return grid;
  }

  InterfaceMesh Mesh() const { return MakeDualMesh(this->Grid(), OnThisThread()); }
};

/** Return a description of the faults of the surface of a label; empty: none. */
inline std::string FaultsOf(const SurfaceTopology& surface, BlockTopology voxels, bool isUnbounded)
{
  // The surface of the unbounded background lacks the surface of the box, which is a sphere.
  const BlockTopology found = { std::llround(surface.Euler()) + isUnbounded,
    surface.Positive + isUnbounded, surface.Negative };
  std::ostringstream text;
  if (surface.BadLinks > 0)
  {
    text << surface.BadLinks << " links are not one cycle, that of vertex " << surface.BadVertex;
  }
  else if (!(found == voxels))
  {
    text << found << "; voxels: " << voxels;
  }
  return text.str();
}

/** Expect closed, oriented manifolds with the topology of the voxels. */
inline void ExpectVoxelTopology(
  const VoxelScene& scene, const InterfaceMesh& mesh,
  const std::function<std::string(int label)>& describe = [](int) { return ""; })
{
  const std::map<int, SurfaceTopology> surfaces = SurfacesOf(mesh);
  int faults = 0;
  for (const auto& [label, voxels] : scene.Voxels().Count())
  {
    if (scene.Outside >= 0 && (label == 0 || label == scene.Outside))
    {
      continue; // There are no faces between sides and these labels.
    }
    const auto found = surfaces.find(label);
    const std::string text =
      found == surfaces.end() ? "no surface" : FaultsOf(found->second, voxels, label == 0);
    if (!text.empty() && ++faults <= 5)
    {
      ADD_FAILURE() << "label " << label << ": " << text << describe(label);
    }
  }
  EXPECT_EQ(faults, 0);
}

/** Expect the same, and that no triangles intersect. */
inline void ExpectSound(const VoxelScene& scene, const InterfaceMesh& mesh)
{
  ExpectVoxelTopology(scene, mesh);
  EXPECT_EQ(CountSelfIntersections(AllFaces(mesh)), 0);
}

/** Random labels from 0 to labels - 1, in a box or in background. */
inline VoxelScene NoiseScene(int side, int labels, unsigned seed, bool isInBox = false)
{
  std::mt19937 random(seed);
  return VoxelScene(
    { side, side, side },
    [&](int, int, int) { return static_cast<int>(random() % static_cast<unsigned>(labels)); },
    isInBox ? labels : -1);
}
}

#endif
