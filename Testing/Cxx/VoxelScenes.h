// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelScenes_h
#define volumicVoxelScenes_h

#include "Core/Interfaces/DualMesh.h"
#include "Core/Mesh/SelfIntersections.h"
#include "SurfaceTopology.h"
#include "VoxelTopology.h"

#include <sstream>

/** Label maps and tests of their meshes. */
namespace volumic
{
/** A label map and its dual mesh. */
struct VoxelScene : VoxelLabels
{
  using VoxelLabels::VoxelLabels;

  std::array<double, 3> Spacing = { 1., 1., 1. };

  void RankAtRandom(unsigned seed)
  {
    std::vector<int> order(this->RankOf.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    this->RankInOrder(order);
  }

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
