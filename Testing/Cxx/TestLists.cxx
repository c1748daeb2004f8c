// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What lists are made with, on all threads: Select.h and Grow.h.
#include "Core/Common/Grow.h"
#include "Core/Common/Select.h"
#include "Core/Common/StandardThreads.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(Select, KeepsTheOrderWhateverTheThreads)
{
  constexpr std::size_t n = 50000;
  std::vector<int> expected;
  for (std::size_t i = 0; i < n; ++i)
  {
    if (i * i % 7 == 2)
    {
      expected.push_back(static_cast<int>(i));
    }
  }
  StandardThreads threads(3);
  const auto isWanted = [](std::size_t i) { return i * i % 7 == 2; };
  const std::vector<int> found = SelectIndices(threads, n, isWanted);
  EXPECT_EQ(found, expected);
}

TEST(Grow, LengthensByLittle)
{
  std::vector<int> values(8000, 1);
  values.shrink_to_fit();
  Grow(values, 8001, 5);
  EXPECT_EQ(values.size(), 8001u);
  EXPECT_EQ(values.back(), 5);
  EXPECT_EQ(values[7999], 1);
  EXPECT_GE(values.capacity(), 9000u); // Not at each step,
  EXPECT_LT(values.capacity(), 10000u); // nor to the double.
  Grow(values, 20000, 6);
  EXPECT_EQ(values.size(), 20000u);
  Grow(values, 3, 7); // Never shorter.
  EXPECT_EQ(values.size(), 20000u);
}
