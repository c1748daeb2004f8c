// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFaceCubes_h
#define volumicFaceCubes_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * The faces of interfaces in cubes that space is cut into, each where its middle is. Cubes have
 * eight colours, so that between two of a colour there is at least another one: what is done in
 * these by threads at the same time touches nothing in common if it stays near.
 */
class FaceCubes
{
public:
  struct Cube
  {
    TriangleBox Box;
    std::size_t First; ///< its faces, in Faces
    std::size_t Last;
  };

  /**
   * @param clearance has the boxes of all faces
   * @param side      of a cube; workspace
   */
  FaceCubes(
    const InterfaceMesh& mesh, const InterfaceClearance& clearance, float side, Executor& executor);

  std::vector<int> Faces; ///< sorted in each cube
  std::array<std::vector<Cube>, 8> OfColour;
};
}

#endif
