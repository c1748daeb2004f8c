// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLimitedSizes_h
#define volumicLimitedSizes_h

#include "Core/Common/Executor.h"
#include "Core/Common/Vector.h"
#include "Core/Mesh/VertexGrid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
/**
 * Lowers sizes of vertices until nowhere they grow by more than the gradation, along the surface or
 * across space: each becomes what the vertices within its reach allow.
 *
 * @param grid  has the vertices that count at their positions
 * @param least what no size is below
 */
template <typename Sizes, typename Positions>
Sizes LimitedSizes(const Sizes& sizes, const Positions& positions, const VertexGrid& grid,
  float least, float gradation, Executor& executor)
{
  constexpr std::size_t grain = 2048; // Vertices that one thread looks at at a time.
  Sizes limited = sizes;
  executor.For(sizes.size(), grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (sizes[v] <= least)
        {
          continue;
        }
        const Vector p = positions[v];
        grid.Visit(p, (sizes[v] - least) / gradation,
          [&](int w)
          {
            const auto other = static_cast<std::size_t>(w);
            limited[v] = std::min(limited[v],
              sizes[other] + gradation * std::sqrt(SquaredDistance(p, positions[other])));
          });
      }
    });
  return limited;
}
}

#endif
