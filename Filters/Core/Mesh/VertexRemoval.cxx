// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/VertexRemoval.h"

namespace volumic
{
bool VertexRemoval::IsLegal(const SurfaceMesh& mesh) const
{
  const Ring& ring = mesh.Rings[this->Vertex];
  return ring.Count == 3 && mesh.Rings[ring.Item[0]].Count > 3 &&
    mesh.Rings[ring.Item[1]].Count > 3 && mesh.Rings[ring.Item[2]].Count > 3;
}

void VertexRemoval::Apply(SurfaceMesh& mesh, VertexSlots* slots) const
{
  for (int i = 0; i < 3; ++i)
  {
    mesh.Rings[mesh.Rings[this->Vertex].Item[i]].Remove(this->Vertex);
  }
  mesh.RemoveVertex(this->Vertex, slots);
}
}
