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
 * Return the offset of the items of each span of [0, n) in a common list, and their total number as
 * the last entry. countIn(begin, end) returns the number of items of a span.
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

/** Return the sum of countIn(begin, end) over all spans of [0, n). */
template <typename CountIn>
std::size_t CountInSpans(Executor& executor, std::size_t n, std::size_t size, CountIn&& countIn)
{
  return FirstOfSpans(executor, n, size, countIn).back();
}

/** Move all lists in order into `all`, whose memory is reused. */
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
      std::copy(
        lists[b].begin(), lists[b].end(), all.begin() + static_cast<std::ptrdiff_t>(first[b]));
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

/** Return, in order, the items that add(i, list) appends for each i of [0, n). */
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
