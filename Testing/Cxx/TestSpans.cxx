// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Spans.h"
#include "Core/Common/StandardThreads.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(Spans, BeginWhereThoseBeforeThemEnd)
{
  // Of the numbers below 103 the multiples of 4, in spans of 10.
  const auto countIn = [](std::size_t begin, std::size_t end)
  {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i)
    {
      count += i % 4 == 0;
    }
    return count;
  };
  StandardThreads threads(3);
  EXPECT_EQ(FirstOfSpans(threads, 103, 10, countIn),
    (std::vector<std::size_t>{ 0, 3, 5, 8, 10, 13, 15, 18, 20, 23, 25, 26 }));
  EXPECT_EQ(CountInSpans(threads, 103, 10, countIn), 26u);
  EXPECT_EQ(CountInSpans(threads, 0, 10, countIn), 0u);
}

TEST(Spans, ListsAreJoinedInTheirOrder)
{
  StandardThreads threads(3);
  std::vector<std::vector<int>> lists = { { 3, 1 }, {}, { 4 }, { 1, 5, 9 } };
  EXPECT_EQ(Joined(threads, lists), (std::vector<int>{ 3, 1, 4, 1, 5, 9 }));
  EXPECT_TRUE(lists[3].empty());
}

TEST(Spans, AreSortedAsAWhole)
{
  StandardThreads threads(3);
  std::mt19937 random(1);
  // Of whole spans and not, with an odd one out in some round of the merge; many equal values.
  for (const std::size_t n : { 0, 1, 15, 16, 17, 32, 48, 80, 81, 257, 1000 })
  {
    for (const int values : { 5, 100000 })
    {
      std::vector<int> numbers(n);
      for (int& number : numbers)
      {
        number = static_cast<int>(random() % static_cast<unsigned int>(values));
      }
      std::vector<int> sorted = numbers;
      std::sort(sorted.begin(), sorted.end());
      SortInSpans(threads, numbers, 16);
      EXPECT_EQ(numbers, sorted) << n << " values up to " << values;
    }
  }
}
