// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/EdgeSplit.h"

namespace volumic
{
bool EdgeSplit::IsLegal(const SurfaceMesh& mesh) const
{
  const Ring& ring = mesh.Rings[this->U];
  const int at = ring.Find(this->V);
  return mesh.Rings[ring.Next(at)].Count < Ring::Capacity &&
    mesh.Rings[ring.Previous(at)].Count < Ring::Capacity;
}

int EdgeSplit::Apply(SurfaceMesh& mesh, const Vector& position, VertexSlots* slots) const
{
  const int at = mesh.Rings[this->U].Find(this->V);
  const int a = mesh.Rings[this->U].Next(at);
  const int b = mesh.Rings[this->U].Previous(at);
  const int m = mesh.AddVertex(position, slots);
  mesh.Rings[this->U].Item[at] = m;
  mesh.Rings[this->V].Replace(this->U, m);
  mesh.Rings[a].InsertAfter(this->U, m);
  mesh.Rings[b].InsertAfter(this->V, m);
  Ring& ring = mesh.Rings[m];
  ring.Count = 4;
  ring.Item[0] = this->U;
  ring.Item[1] = b;
  ring.Item[2] = this->V;
  ring.Item[3] = a;
  return m;
}
}
