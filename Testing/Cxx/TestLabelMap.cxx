// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTestTools.h"

using namespace volumic;

namespace
{
using Numbers = std::vector<LabelMap::Number>;

/** One of three objects in blocks of five voxels, and single voxels of others by chance. */
int ObjectAt(int i, int j, int k)
{
  const auto mixed = static_cast<unsigned>(i * 7919 + j * 104729 + k * 1299709) * 2654435761u;
  return mixed >> 24 == 0 ? 4 + static_cast<int>(mixed % 7) : (i / 5 + j / 5 + k / 5) % 3;
}

/** All voxels of a map, x fastest. */
Numbers VoxelsOf(const LabelMap& map)
{
  Numbers voxels;
  ForVoxels(map.Size(), [&](int i, int j, int k) { voxels.push_back(map.At(i, j, k)); });
  return voxels;
}

class LabelMapOfSizes : public testing::TestWithParam<std::array<int, 3>>
{
protected:
  LabelMap Map = MakeLabelMap(GetParam(), 10, ObjectAt);
};
}

TEST_P(LabelMapOfSizes, HasWhatIsSet)
{
  ForVoxels(
    GetParam(), [&](int i, int j, int k) { EXPECT_EQ(this->Map.At(i, j, k), ObjectAt(i, j, k)); });
  const auto [i, j, k] = GetParam();
  for (const auto& [x, y, z] : std::vector<std::array<int, 3>>{
         { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, -1 }, { i, 0, 0 }, { 0, j, 0 }, { 0, 0, k } })
  {
    EXPECT_EQ(this->Map.At(x, y, z), 0) << "outside";
  }
}

TEST_P(LabelMapOfSizes, TakesLayersThatItGives)
{
  LabelMap other(GetParam());
  for (int pass = 0; pass < 2; ++pass) // The second one over what is there.
  {
    for (int layer = 0; layer < this->Map.NumberOfLayers(); ++layer)
    {
      const VoxelBox box = this->Map.Layer(layer);
      Numbers voxels(static_cast<std::size_t>(box.Count()), 99);
      this->Map.CopyLayer(layer, voxels.data());
      other.PutLayer(layer, voxels.data());
    }
    EXPECT_EQ(VoxelsOf(other), VoxelsOf(this->Map));
  }
}

TEST_P(LabelMapOfSizes, PartsOfABoxAreItsVoxels)
{
  const auto [i, j, k] = GetParam();
  const VoxelBox all = VoxelBox::Of(GetParam());
  for (const VoxelBox& box : { all, VoxelBox{ { i / 3, j / 4, k / 5 }, { i, j - j / 3, k } },
         VoxelBox{ { i / 2, j / 2, k / 2 }, { i / 2 + 1, j / 2 + 1, k / 2 + 1 } }, VoxelBox{} })
  {
    std::map<std::array<int, 3>, int> found;
    this->Map.ForParts(box,
      [&](const VoxelBox& part, LabelMap::Number object)
      {
        ForBox(part.First, part.End,
          [&](int x, int y, int z)
          {
            EXPECT_TRUE(found.emplace(std::array<int, 3>{ x, y, z }, object).second);
            EXPECT_EQ(object, ObjectAt(x, y, z));
            EXPECT_TRUE(box.Contains({ x, y, z }));
          });
      });
    EXPECT_EQ(static_cast<std::int64_t>(found.size()), box.Count());
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, LabelMapOfSizes,
  testing::Values(std::array<int, 3>{ 8, 8, 8 }, std::array<int, 3>{ 17, 23, 31 },
    std::array<int, 3>{ 3, 40, 9 }));
