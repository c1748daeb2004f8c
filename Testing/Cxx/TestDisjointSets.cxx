// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/DisjointSets.h"

#include <gtest/gtest.h>

using namespace volumic;

TEST(DisjointSets, RootIsTheSmallestMember)
{
  DisjointSets sets(10);
  EXPECT_EQ(sets.Join(7, 3), 3);
  EXPECT_EQ(sets.Join(9, 8), 8);
  EXPECT_EQ(sets.Join(8, 7), 3);
  for (int i = 0; i < 10; ++i)
  {
    const int root = i == 7 || i == 8 || i == 9 ? 3 : i;
    EXPECT_EQ(sets.FindRoot(i), root);
    EXPECT_EQ(sets.Find(i), root);
  }
  EXPECT_EQ(sets.Join(9, 3), 3) << "joined already";
}

TEST(DisjointSets, AreMadeAfresh)
{
  DisjointSets sets(3);
  sets.Join(0, 1);
  sets.Join(1, 2);
  sets.Resize(4);
  for (int i = 0; i < 4; ++i)
  {
    sets.MakeSet(i);
  }
  EXPECT_EQ(sets.Find(2), 2);
  EXPECT_EQ(sets.Find(3), 3);
}
