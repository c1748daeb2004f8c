// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/CellPattern.h"
#include "InterfaceTestTools.h"
#include "ThreadTestTools.h"
#include "VoxelScenes.h"

using namespace volumic;

namespace
{
/** Return all partitions of the octants of a cell into labels, numbered by first occurrence. */
std::vector<std::array<int, 8>> AllPatterns()
{
  std::vector<std::array<int, 8>> patterns;
  std::array<int, 8> pattern = {};
  const std::function<void(int, int)> add = [&](int octant, int labels)
  {
    if (octant == 8)
    {
      patterns.push_back(pattern);
      return;
    }
    for (int label = 0; label <= labels; ++label)
    {
      pattern[static_cast<std::size_t>(octant)] = label;
      add(octant + 1, std::max(labels, label + 1));
    }
  };
  add(0, 0);
  return patterns;
}

/**
 * Test all patterns in one map, each with its own labels and surrounded by background.
 * @param isWithBackground whether one label of each pattern is the background
 */
void ExpectSoundPatterns(bool isWithBackground, unsigned seed)
{
  std::mt19937 random(seed);
  const std::vector<std::array<int, 8>> patterns = AllPatterns();
  ASSERT_EQ(patterns.size(), 4140u);
  std::vector<std::array<int, 8>> blocks;
  std::vector<std::size_t> blockOf = { 0 };
  for (const std::array<int, 8>& pattern : patterns)
  {
    const int labels = 1 + *std::max_element(pattern.begin(), pattern.end());
    const int background = isWithBackground ? static_cast<int>(random() % labels) : -1;
    const int first = static_cast<int>(blockOf.size());
    blocks.push_back(pattern);
    for (int& label : blocks.back())
    {
      label = label == background ? 0 : first + label;
    }
    blockOf.resize(blockOf.size() + static_cast<std::size_t>(labels), blocks.size() - 1);
  }
  const Voxel counts = { 17, 16, 16 };
  VoxelScene scene({ 3 * counts[0], 3 * counts[1], 3 * counts[2] },
    [&](int i, int j, int k)
    {
      const int n = i / 3 + counts[0] * (j / 3 + counts[1] * (k / 3));
      return i % 3 == 2 || j % 3 == 2 || k % 3 == 2 || n >= static_cast<int>(blocks.size())
        ? 0
        : blocks[static_cast<std::size_t>(n)]
                [static_cast<std::size_t>(i % 3 + 2 * (j % 3) + 4 * (k % 3))];
    });
  scene.RankAtRandom(seed);
  const InterfaceMesh mesh = scene.Mesh();
  if (seed == 1) // The test is slow.
  {
    EXPECT_EQ(CountSelfIntersections(AllFaces(mesh)), 0);
  }
  ExpectVoxelTopology(scene, mesh,
    [&](int label)
    {
      std::ostringstream text("; octants (rank):", std::ios::ate);
      for (const int octant : blocks[blockOf[static_cast<std::size_t>(label)]])
      {
        text << ' ' << octant << " (" << scene.RankOf[static_cast<std::size_t>(octant)] << ')';
      }
      return text.str();
    });
}

/** Voronoi cells of random points, numbered from `first`. */
VoxelScene GrainScene(int side, int grains, int first, unsigned seed, int outside = -1)
{
  const LabelMap map = Grains({ side, side, side }, { 1., 1., 1. }, grains, seed);
  return VoxelScene(
    { side, side, side }, [&](int i, int j, int k) { return map.At(i, j, k) - 1 + first; },
    outside);
}

/** Expect the topology of a label from its voxels and from the mesh. */
void ExpectBlock(const VoxelScene& scene, int label, const BlockTopology& expected)
{
  EXPECT_EQ(scene.Voxels().Count().at(label), expected);
  ExpectSound(scene, scene.Mesh());
}
}

TEST(DualMesh, PreservesTopologyOfAllPatterns)
{
  for (const unsigned seed : { 1, 2, 3 })
  {
    ExpectSoundPatterns(false, seed);
    ExpectSoundPatterns(true, seed);
  }
}

TEST(DualMesh, PreservesTopologyOfNoise)
{
  for (const int labels : { 2, 3, 5, 10 })
  {
    SCOPED_TRACE(labels);
    VoxelScene scene = NoiseScene(12, labels, 10u + static_cast<unsigned>(labels));
    ExpectSound(scene, scene.Mesh());
    scene.RankAtRandom(static_cast<unsigned>(labels));
    scene.Spacing = { 1., 2.5, 20. };
    ExpectSound(scene, scene.Mesh());
  }
}

TEST(DualMesh, PreservesIsolatedAndDiagonalVoxels)
{
  std::mt19937 random(1);
  int labels = 0;
  const VoxelScene isolated(
    { 16, 16, 16 }, [&](int, int, int) { return random() % 4 == 0 ? ++labels : 0; });
  ExpectSound(isolated, isolated.Mesh());
  for (int other = 1; other <= 2; ++other)
  {
    const auto pair = [&](const Voxel& voxel)
    {
      return VoxelScene({ 4, 4, 4 },
        [=](int i, int j, int k) {
          return Voxel{ i, j, k } == Voxel{ 1, 1, 1 } ? 1 : Voxel{ i, j, k } == voxel ? other : 0;
        });
    };
    const int parts = other == 1 ? 2 : 1;
    ExpectBlock(pair({ 2, 2, 1 }), 1, { 1, 1, 0 });
    ExpectBlock(pair({ 2, 2, 2 }), 1, { parts, parts, 0 });
  }
}

TEST(DualMesh, IsIndependentOfThreadCount)
{
  for (const VoxelScene& scene : { NoiseScene(20, 4, 1), GrainScene(40, 20, 0, 2) })
  {
    std::set<std::uint64_t> hashes;
    for (const int threads : { 1, 2, 3 })
    {
      DelayedThreads executor(threads, 1, 200);
      const InterfaceMesh mesh = MakeDualMesh(scene.Grid(), executor);
      hashes.insert(HashOf(mesh.Faces, HashOf(mesh.Position)));
    }
    EXPECT_EQ(hashes.size(), 1u);
  }
}

TEST(DualMesh, LiesInPlanesOfBoxSides)
{
  for (VoxelScene scene : { NoiseScene(8, 2, 1, true), NoiseScene(8, 4, 2, true),
         NoiseScene(8, 9, 3, true), GrainScene(12, 15, 1, 1, 16) })
  {
    scene.Spacing = { 1., 1., 3. };
    const InterfaceMesh mesh = scene.Mesh();
    ExpectSound(scene, mesh);
    for (const InterfaceMesh::Face& face : mesh.Faces)
    {
      for (const int v : face.Vertex)
      {
        const Vector& p = mesh.Position[static_cast<std::size_t>(v)];
        const std::array<float, 3> at = { p.X, p.Y, p.Z };
        const int side = face.Front - mesh.FirstSide;
        EXPECT_TRUE(side < 0 || at[side / 2] == mesh.Planes[static_cast<std::size_t>(side)]);
      }
    }
  }
  double volume = 0.;
  for (const auto& surface : SurfacesOf(GrainScene(12, 15, 1, 1, 16).Mesh()))
  {
    volume += surface.second.Volume;
  }
  EXPECT_NEAR(volume, 12. * 12. * 12., 1e-3);
}
