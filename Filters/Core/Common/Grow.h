// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGrow_h
#define volumicGrow_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace volumic
{
/** As many values as there are, and an eighth: memory that is not touched costs nothing. */
constexpr std::size_t WithRoomToGrow(std::size_t n)
{
  return n + n / 8;
}

/**
 * Lengthens a vector to n values, if it is shorter, by an eighth at least: the library would double
 * the memory, which of a surface that hardly grows any more is half of it for nothing.
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
