// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLiveSurface_h
#define volumicLiveSurface_h

#include "Core/Mesh/TriangleTests.h"
#include "Core/Surface/SurfaceState.h"
#include "CoreTestTools.h"

namespace volumic
{
/** A surface with its shape, without a proximity test. */
struct LiveSurface : SurfaceState
{
  explicit LiveSurface(const IndexedSurface& surface, float delta = 1)
    : LiveSurface(MeshOf(surface), delta)
  {
  }
  explicit LiveSurface(const SurfaceMesh& mesh, float delta = 1)
  {
    this->Mesh = mesh;
    this->Sizing = SizingField(delta);
    this->Reset(Vector(-30, -30, -30), Vector(70, 40, 40));
    this->UpdateShape(this->All(), OnThisThread());
  }

  std::vector<int> All() const
  {
    std::vector<int> all(this->Mesh.Size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
};

inline MeshTriangle Named(int name, const VectorD& a, const VectorD& b, const VectorD& c)
{
  return { { name, name + 1, name + 2 }, { a, b, c } };
}
}

#endif
