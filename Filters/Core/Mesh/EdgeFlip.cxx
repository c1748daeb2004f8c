// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/EdgeFlip.h"

namespace volumic
{
EdgeFlip EdgeFlip::Of(const SurfaceMesh& mesh, int u, int v)
{
  const Ring& ring = mesh.Rings[u];
  const int at = ring.Find(v);
  return { u, v, ring.Next(at), ring.Previous(at) };
}

bool EdgeFlip::IsLegal(const SurfaceMesh& mesh) const
{
  return this->A != this->B && mesh.Rings[this->U].Count > 3 && mesh.Rings[this->V].Count > 3 &&
    mesh.Rings[this->A].Count < Ring::Capacity && mesh.Rings[this->B].Count < Ring::Capacity &&
    !mesh.AreNeighbours(this->A, this->B);
}

void EdgeFlip::Apply(SurfaceMesh& mesh) const
{
  mesh.Rings[this->U].Remove(this->V);
  mesh.Rings[this->V].Remove(this->U);
  mesh.Rings[this->A].InsertAfter(this->U, this->B);
  mesh.Rings[this->B].InsertAfter(this->V, this->A);
}
}
