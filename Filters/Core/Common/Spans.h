// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSpans_h
#define volumicSpans_h

#include "Core/Common/Executor.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace volumic
{
/**
 * For lists that threads fill at once: the place at which the items of each span of [0, n) begin,
 * if they follow those of the spans before, and the number of all as the last entry.
 * countIn(begin, end) tells how many items a span has.
 */
template <typename CountIn>
std::vector<std::size_t> FirstOfSpans(
  Executor& executor, std::size_t n, std::size_t size, CountIn&& countIn)
{
  std::vector<std::size_t> first((n + size - 1) / size + 1, 0);
  ForSpans(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    { first[b + 1] = static_cast<std::size_t>(countIn(begin, end)); });
  for (std::size_t b = 1; b < first.size(); ++b)
  {
    first[b] += first[b - 1];
  }
  return first;
}

/** The sum of the counts countIn(begin, end) of all spans of [0, n). */
template <typename CountIn>
std::size_t CountInSpans(Executor& executor, std::size_t n, std::size_t size, CountIn&& countIn)
{
  return FirstOfSpans(executor, n, size, countIn).back();
}

/** Joins lists, which are emptied, in their order; the memory of `all` is used again. */
template <typename T, typename Allocator>
void Concatenate(
  Executor& executor, std::vector<std::vector<T>>& lists, std::vector<T, Allocator>& all)
{
  std::vector<std::size_t> first(lists.size() + 1, 0);
  for (std::size_t b = 0; b < lists.size(); ++b)
  {
    first[b + 1] = first[b] + lists[b].size();
  }
  all.resize(first.back());
  ForSpans(executor, lists.size(), 1,
    [&](std::size_t b, std::size_t, std::size_t)
    {
      std::copy(lists[b].begin(), lists[b].end(),
        all.begin() + static_cast<std::ptrdiff_t>(first[b]));
      std::vector<T>().swap(lists[b]);
    });
}

template <typename T>
std::vector<T> Joined(Executor& executor, std::vector<std::vector<T>>& lists)
{
  std::vector<T> all;
  Concatenate(executor, lists, all);
  return all;
}

/** Joins what add(i, list) adds for each i of [0, n), in their order. */
template <typename T, typename Add>
std::vector<T> CollectInSpans(Executor& executor, std::size_t n, std::size_t size, Add&& add)
{
  std::vector<std::vector<T>> lists((n + size - 1) / size);
  ForSpans(executor, n, size,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        add(i, lists[span]);
      }
    });
  return Joined(executor, lists);
}

namespace detail
{
/**
 * How many of the first `count` items of two sorted ranges, merged, come from the left one; of
 * equal ones those on the left come first.
 */
template <typename Iterator>
std::ptrdiff_t CountOfLeft(Iterator left, std::ptrdiff_t lefts, Iterator right,
  std::ptrdiff_t rights, std::ptrdiff_t count)
{
  std::ptrdiff_t low = std::max<std::ptrdiff_t>(0, count - rights);
  std::ptrdiff_t high = std::min(count, lefts);
  while (low < high)
  {
    const std::ptrdiff_t middle = low + (high - low) / 2;
    if (right[count - middle - 1] < left[middle])
    {
      high = middle;
    }
    else
    {
      low = middle + 1;
    }
  }
  return low;
}
}

/**
 * std::sort by threads, for values of which equal ones are alike: sorted in spans, which are then
 * merged by twos. Needs as much memory again.
 */
template <typename T, typename Allocator>
void SortInSpans(
  Executor& executor, std::vector<T, Allocator>& values, std::size_t size = 1 << 15)
{
  const std::size_t n = values.size();
  const auto at = [](std::vector<T, Allocator>& list, std::size_t i)
  { return list.begin() + static_cast<std::ptrdiff_t>(i); };
  ForSpans(executor, n, size, [&](std::size_t, std::size_t begin, std::size_t end)
    { std::sort(at(values, begin), at(values, end)); });
  std::vector<T, Allocator> merged(n > size ? n : 0);
  for (std::size_t width = size; width < n; width *= 2)
  {
    // Each span of what is merged is made of parts of two sorted ranges.
    ForSpans(executor, n, size,
      [&](std::size_t, std::size_t begin, std::size_t end)
      {
        const std::size_t first = begin / (2 * width) * (2 * width);
        const auto left = at(values, first);
        const auto right = at(values, std::min(first + width, n));
        const auto last = at(values, std::min(first + 2 * width, n));
        const auto from = static_cast<std::ptrdiff_t>(begin - first);
        const auto to = static_cast<std::ptrdiff_t>(end - first);
        const std::ptrdiff_t a = detail::CountOfLeft(left, right - left, right, last - right, from);
        const std::ptrdiff_t b = detail::CountOfLeft(left, right - left, right, last - right, to);
        std::merge(
          left + a, left + b, right + (from - a), right + (to - b), at(merged, begin));
      });
    values.swap(merged);
  }
}
}

#endif
