// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/VertexProperties.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
struct TwoProperties
{
  SequentialExecutor Thread;
  VertexProperties All;
  VertexProperty<int> Inherited{ this->All, 1 };
  VertexProperty<float> Own{ this->All, 2.f, 3.f };
};
}

TEST(VertexProperties, AreResetTogether)
{
  TwoProperties p;
  p.All.Reset(3, p.Thread);
  p.Inherited[1] = 7;
  p.Own[2] = 7.f;
  p.All.Reset(4, p.Thread);
  ASSERT_EQ(p.Inherited.Size(), 4u);
  ASSERT_EQ(p.Own.Size(), 4u);
  for (int v = 0; v < 4; ++v)
  {
    EXPECT_EQ(p.Inherited[v], 1);
    EXPECT_EQ(p.Own[v], 2.f);
  }
}

TEST(VertexProperties, GrowTogether)
{
  TwoProperties p;
  p.All.Reset(3, p.Thread);
  p.Inherited[1] = 7;
  p.Own[1] = 7.f;
  p.All.Add(3, 1);
  ASSERT_EQ(p.Inherited.Size(), 4u);
  ASSERT_EQ(p.Own.Size(), 4u);
  EXPECT_EQ(p.Inherited[3], 7) << "its parent's";
  EXPECT_EQ(p.Own[3], 3.f) << "that of new vertices";
}

TEST(VertexProperties, TakeNewVerticesInPlacesOfRemovedOnes)
{
  TwoProperties p;
  p.All.Reset(3, p.Thread);
  p.Inherited[0] = 5;
  p.Inherited[2] = 7;
  p.Own[2] = 7.f;
  p.All.Add(2, 0);
  EXPECT_EQ(p.Inherited.Size(), 3u);
  EXPECT_EQ(p.Inherited[2], 5);
  EXPECT_EQ(p.Own[2], 3.f);
}

TEST(VertexProperties, HashesTellWhoseValueIsAnother)
{
  TwoProperties p;
  p.All.Reset(3, p.Thread);
  const std::vector<int> vertices = { 2, 0 };
  const auto hashes = [&]
  {
    std::vector<std::uint64_t> found(vertices.size(), 5);
    p.All.AddTo(found, vertices);
    return found;
  };
  const std::vector<std::uint64_t> before = hashes();
  EXPECT_EQ(before[0], before[1]) << "the same values";
  EXPECT_EQ(hashes(), before);
  p.Inherited[1] = 7;
  EXPECT_EQ(hashes(), before) << "not asked for";
  p.Inherited[0] = 7;
  EXPECT_EQ(hashes()[0], before[0]);
  EXPECT_NE(hashes()[1], before[1]);
  p.Own[2] = -2.f;
  EXPECT_NE(hashes()[0], before[0]);
  EXPECT_NE(hashes()[0], hashes()[1]);
}
