// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLiveSurface_h
#define volumicLiveSurface_h

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
    this->UpdateShape();
  }

  /** Return the vertices that are alive. */
  std::vector<int> All() const
  {
    std::vector<int> all;
    for (int v = 0; v < this->Mesh.Size(); ++v)
    {
      if (this->Mesh.IsAlive(v))
      {
        all.push_back(v);
      }
    }
    return all;
  }

  using SurfaceState::UpdateShape;
  void UpdateShape() { this->UpdateShape(this->All(), OnThisThread()); }

  /** Test the invariants after edits. */
  bool IsSound() const
  {
    return DescribeBrokenInvariant(this->Mesh).empty() &&
      CountSelfIntersections(this->Mesh.ToIndexed(), 1) == 0 &&
      this->Mesh.CountEulerCharacteristic() == this->EulerCharacteristic;
  }
};
}

#endif
