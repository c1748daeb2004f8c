// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/CycleCut.h"

namespace volumic
{
bool CycleCut::IsLegal(const SurfaceMesh& mesh) const
{
  const Ring& a = mesh.Rings[this->A];
  const int b = a.Find(this->B);
  const int c = a.Find(this->C);
  return b >= 0 && c >= 0 && mesh.AreNeighbours(this->B, this->C) && a.Next(b) != this->C &&
    a.Next(c) != this->B;
}

std::array<int, 3> CycleCut::Apply(SurfaceMesh& mesh, VertexSlots* slots) const
{
  const std::array<int, 3> corner = { this->A, this->B, this->C };
  std::array<int, 3> copy;
  std::array<Ring, 3> right;
  for (int k = 0; k < 3; ++k)
  {
    const int next = corner[(k + 1) % 3];
    const int previous = corner[(k + 2) % 3];
    const Ring old = mesh.Rings[corner[k]];
    Ring left;
    for (int i = old.Find(next);; i = (i + 1) % old.Count)
    {
      left.Item[left.Count++] = old.Item[i];
      if (old.Item[i] == previous)
      {
        break;
      }
    }
    for (int i = old.Find(previous);; i = (i + 1) % old.Count)
    {
      right[k].Item[right[k].Count++] = old.Item[i];
      if (old.Item[i] == next)
      {
        break;
      }
    }
    mesh.Rings[corner[k]] = left;
  }
  for (int k = 0; k < 3; ++k)
  {
    const Vector position = mesh.Position[corner[k]];
    copy[k] = mesh.AddVertex(position, slots);
  }
  for (int k = 0; k < 3; ++k)
  {
    Ring& ring = right[k];
    for (int i = 1; i + 1 < ring.Count; ++i)
    {
      mesh.Rings[ring.Item[i]].Replace(corner[k], copy[k]);
    }
    ring.Item[0] = copy[(k + 2) % 3];
    ring.Item[ring.Count - 1] = copy[(k + 1) % 3];
    mesh.Rings[copy[k]] = ring;
  }
  return copy;
}
}
