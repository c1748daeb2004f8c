// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicConnectedVertices_h
#define volumicConnectedVertices_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <vector>

namespace volumic
{
/**
 * The sets of vertices that edges join: the components of a surface. The same for any executor;
 * O(vertices).
 */
class ConnectedVertices
{
public:
  /** Labels alive vertices, by set, from 0, in the order of their smallest ones. */
  void Label(const SurfaceMesh& mesh, LargeVector<int>& labels, Executor& executor);

  /** By label: its smallest vertex. */
  const std::vector<int>& Roots() const { return this->SmallestOnes; }

private:
  std::vector<int> SmallestOnes;
};
}

#endif
