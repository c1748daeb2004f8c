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
 * Return vertex sizes lowered so that they nowhere grow by more than the gradation times the
 * Euclidean distance.
 * @param grid contains the vertices at their positions
 * @param least lower bound of all sizes
 */
template <typename Sizes, typename Positions>
Sizes LimitedSizes(const Sizes& sizes, const Positions& positions, const VertexGrid& grid,
  float least, float gradation, Executor& executor)
{
  constexpr std::size_t grain = 2048;
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
