// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleSurface_h
#define volumicTriangleSurface_h

#include <array>
#include <vector>

namespace volumic::support
{

/** Indexed triangles, counter-clockwise seen from outside. */
struct TriangleSurface
{
  std::vector<std::array<double, 3>> Points;
  std::vector<std::array<int, 3>> Triangles; ///< indices into Points
};

} // namespace volumic::support

#endif
