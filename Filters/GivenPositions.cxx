// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GivenPositions.h"

#include "Core/Common/Refuse.h"

#include <algorithm>
#include <cstddef>

namespace volumic
{
std::vector<Point> PositionsOf(const std::vector<Point>& positions, const char* label,
  const Workspace& space, const std::array<int, 3>& size)
{
  std::vector<Point> places;
  for (std::size_t id = 0; id < positions.size(); ++id)
  {
    const Point& world = positions[id];
    Point place = space.ToWorkspace(world);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double step = space.Step()[axis];
      const double length = step * size[axis];
      // Written so that NaN is refused too.
      if (!(place[axis] >= -step && place[axis] <= length + step))
      {
        Refuse(label, ": point ", id, " (", world[0], ", ", world[1], ", ", world[2],
          ") lies outside the image. Points are in world coordinates; move it into the image, or "
          "remove it.");
      }
      // Not the very end of the box, which the levels have rounded.
      place[axis] = std::max(0.0, std::min((1.0 - 1e-9) * length, place[axis]));
    }
    places.push_back(place);
  }
  return places;
}
}
