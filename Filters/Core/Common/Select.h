// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSelect_h
#define volumicSelect_h

#include "Core/Common/Executor.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace volumic
{
/** Return the indices i < n for which isSelected(i), in order. It is called on any thread. */
template <typename IsSelected>
std::vector<int> SelectIndices(Executor& executor, std::size_t n, IsSelected&& isSelected)
{
  constexpr std::size_t size = 2048;
  std::vector<std::vector<int>> spans((n + size - 1) / size);
  ForSpans(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      int found[size];
      std::size_t count = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        if (isSelected(i))
        {
          found[count++] = static_cast<int>(i);
        }
      }
      spans[b].assign(found, found + count);
    });
  return Joined<int>(executor, spans);
}

/** Sort the items and remove duplicates. */
template <typename T>
void SortUnique(std::vector<T>& items)
{
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}
}

#endif
