// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVerticesOfSlabs_h
#define volumicVerticesOfSlabs_h

#include "Core/Common/Executor.h"
#include "Core/Image/LevelImage.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * For each slab of layers of an image the vertices that matter there: those less than a reach from
 * one of its layers along z, and those of whose faces one may cross a layer. A vertex may matter in
 * several slabs.
 */
class VerticesOfSlabs
{
public:
  /** @param reach workspace */
  VerticesOfSlabs(const SurfaceMesh& mesh, const LevelImage& image, int layersOfSlab, double reach,
    Executor& executor);

  /** Those of a slab, by index. */
  const int* Begin(std::size_t slab) const { return this->Vertices.data() + this->First[slab]; }
  std::size_t Count(std::size_t slab) const { return this->First[slab + 1] - this->First[slab]; }

private:
  std::vector<std::size_t> First; ///< Of each slab, and the end of the last.
  LargeVector<int> Vertices;
};
}

#endif
