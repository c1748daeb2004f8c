// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/VoxelNumbers.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(VoxelNumbers, CountMoreThanAnIntDoes)
{
  EXPECT_EQ(VoxelNumbers({ 1300, 1300, 1300 }).Count(), 2197000000);
  EXPECT_EQ(VoxelNumbers({ 2048, 2048, 2048 }).Count(), std::int64_t(1) << 33);
  // A slice alone.
  EXPECT_EQ(VoxelNumbers({ 65536, 65536, 2 }).Count(), std::int64_t(1) << 33);
}

TEST(VoxelNumbers, ComeBackToTheirPlaces)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1300, 1300, 1300 },
         { 2048, 2048, 2048 }, { 3, 5, 7 }, { 65536, 65536, 2 }, { 1, 1, 70000 } })
  {
    const VoxelNumbers numbers(size);
    EXPECT_EQ(numbers.Of(0, 0, 0), 0);
    const std::array<int, 3> last = { size[0] - 1, size[1] - 1, size[2] - 1 };
    EXPECT_EQ(numbers.Of(last[0], last[1], last[2]), numbers.Count() - 1);
    const std::array<int, 3> middle = { size[0] / 2, size[1] / 3, last[2] };
    for (const std::array<int, 3>& place : { last, middle })
    {
      EXPECT_EQ(numbers.PlaceOf(numbers.Of(place[0], place[1], place[2])), place);
    }
  }
}

TEST(VoxelNumbers, GrowByTheStrides)
{
  const VoxelNumbers numbers({ 1300, 1400, 1500 });
  const std::int64_t number = numbers.Of(1298, 1398, 1498);
  EXPECT_EQ(number + numbers.Stride(0), numbers.Of(1299, 1398, 1498));
  EXPECT_EQ(number + numbers.Stride(1), numbers.Of(1298, 1399, 1498));
  EXPECT_EQ(number + numbers.Stride(2), numbers.Of(1298, 1398, 1499));
}

TEST(NumberOfEdges, CountsMoreThanAnIntDoes)
{
  EXPECT_EQ(NumberOfEdges(4, 2), 6);
  EXPECT_EQ(NumberOfEdges(12, 2), 30);
  EXPECT_EQ(2 * NumberOfEdges(400000000, 2), 2399999988);
  EXPECT_EQ(NumberOfEdges(1000000000, -100), 3000000300);
}
