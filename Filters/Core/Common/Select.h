// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSelect_h
#define volumicSelect_h

#include "Core/Common/Executor.h"

#include <cstddef>
#include <vector>

namespace volumic
{
/** Appends valueOf(i) for all i of [0, n) for which isWanted(i), in order; on any thread. */
template <typename IsWanted, typename ValueOf>
void SelectValues(Executor& executor, std::size_t n, std::vector<int>& selected,
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
  std::size_t total = selected.size();
  for (const std::vector<int>& block : blocks)
  {
    total += block.size();
  }
  selected.reserve(total);
  for (const std::vector<int>& block : blocks)
  {
    selected.insert(selected.end(), block.begin(), block.end());
  }
}

/** The indices below n that are wanted, in order. */
template <typename IsWanted>
std::vector<int> SelectIndices(Executor& executor, std::size_t n, IsWanted&& isWanted)
{
  std::vector<int> selected;
  SelectValues(executor, n, selected, isWanted, [](std::size_t i) { return static_cast<int>(i); });
  return selected;
}

/** Those of a list that are wanted, in order. */
template <typename IsWanted>
std::vector<int> SelectOf(Executor& executor, const std::vector<int>& list, IsWanted&& isWanted)
{
  std::vector<int> selected;
  SelectValues(
    executor, list.size(), selected, [&](std::size_t i) { return isWanted(list[i]); },
    [&list](std::size_t i) { return list[i]; });
  return selected;
}
}

#endif
