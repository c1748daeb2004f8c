// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGrow_h
#define volumicGrow_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace volumic
{
/** Return n and an eighth more. Memory that is not touched costs nothing. */
constexpr std::size_t WithRoomToGrow(std::size_t n)
{
  return n + n / 8;
}

/**
 * Resize a vector to n values if it is shorter, and its capacity by an eighth at least. The
 * standard library would double the memory, half of which stays unused in a surface that hardly
 * grows.
 */
template <typename T, typename Allocator>
void Grow(std::vector<T, Allocator>& values, std::size_t n, const T& value)
{
  if (n > values.capacity())
  {
    values.reserve(std::max(n, WithRoomToGrow(values.capacity())));
  }
  if (n > values.size())
  {
    values.resize(n, value);
  }
}
}

#endif
