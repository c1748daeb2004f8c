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
}

#endif
