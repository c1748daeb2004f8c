// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/DisjointSets.h"
#include "Core/Common/StandardThreads.h"
#include "TestPrelude.h"

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

TEST(DisjointSets, AreTheSameWhoeverJoinsThemAtOnce)
{
  constexpr int n = 3000;
  std::mt19937 random(7);
  StandardThreads threads(4);
  for (int round = 0; round < 20; ++round)
  {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < n * (1 + round % 3) / 3; ++i)
    {
      pairs.emplace_back(static_cast<int>(random() % n), static_cast<int>(random() % n));
    }
    DisjointSets alone(n);
    for (const auto& pair : pairs)
    {
      alone.Join(pair.first, pair.second);
    }
    SharedDisjointSets shared(n);
    threads.For(pairs.size(), 1,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          shared.Join(pairs[i].first, pairs[i].second);
        }
      });
    for (int i = 0; i < n; ++i)
    {
      ASSERT_EQ(shared.Find(i), alone.Find(i));
    }
  }
}
