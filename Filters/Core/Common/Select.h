// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSelect_h
#define volumicSelect_h

#include "Core/Common/Blocks.h"
#include "Core/Common/Executor.h"

#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * Fills a list with valueOf(i) for all i of [0, n) for which isWanted(i), in order; both are called
 * on any thread. The list's memory is used again.
 */
template <typename Allocator, typename IsWanted, typename ValueOf>
void Select(Executor& executor, std::size_t n, std::vector<int, Allocator>& selected,
  IsWanted&& isWanted, ValueOf&& valueOf)
{
  constexpr std::size_t size = 2048;
  std::vector<std::vector<int>> blocks((n + size - 1) / size);
  ForBlocks(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      int found[size];
      std::size_t count = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        if (isWanted(i))
        {
          found[count++] = valueOf(i);
        }
      }
      blocks[b].assign(found, found + count);
    });
  Concatenate(executor, blocks, selected);
}

/** The indices below n that are wanted, in order. */
template <typename IsWanted>
std::vector<int> SelectIndices(Executor& executor, std::size_t n, IsWanted&& isWanted)
{
  std::vector<int> selected;
  Select(executor, n, selected, isWanted, [](std::size_t i) { return static_cast<int>(i); });
  return selected;
}

/** Those of a list that are wanted, in order. */
template <typename IsWanted>
std::vector<int> SelectOf(Executor& executor, const std::vector<int>& list, IsWanted&& isWanted)
{
  std::vector<int> selected;
  Select(
    executor, list.size(), selected, [&](std::size_t i) { return isWanted(list[i]); },
    [&list](std::size_t i) { return list[i]; });
  return selected;
}
}

#endif
