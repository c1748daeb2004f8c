// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/EdgeCollapse.h"

namespace volumic
{
bool EdgeCollapse::IsLegal(const SurfaceMesh& mesh) const
{
  const Ring& ring = mesh.Rings[this->Kept];
  const int at = ring.Find(this->Removed);
  const int count = ring.Count + mesh.Rings[this->Removed].Count - 4;
  return mesh.Rings[ring.Next(at)].Count > 3 && mesh.Rings[ring.Previous(at)].Count > 3 &&
    count >= 3 && count <= Ring::Capacity && this->ThirdCommonNeighbour(mesh) < 0;
}

int EdgeCollapse::ThirdCommonNeighbour(const SurfaceMesh& mesh) const
{
  const Ring& ring = mesh.Rings[this->Kept];
  const int at = ring.Find(this->Removed);
  const int a = ring.Next(at);
  const int b = ring.Previous(at);
  const Ring& other = mesh.Rings[this->Removed];
  int best = -1;
  float shortest = 0;
  for (int i = 0; i < ring.Count; ++i)
  {
    const int c = ring.Item[i];
    if (c != a && c != b && c != this->Removed && other.Contains(c))
    {
      const float length = SquaredDistance(mesh.Position[c], mesh.Position[this->Kept]) +
        SquaredDistance(mesh.Position[c], mesh.Position[this->Removed]);
      if (best < 0 || length < shortest)
      {
        best = c;
        shortest = length;
      }
    }
  }
  return best;
}

void EdgeCollapse::Apply(SurfaceMesh& mesh, VertexSlots* slots) const
{
  const Ring old = mesh.Rings[this->Kept];
  const Ring& other = mesh.Rings[this->Removed];
  const int at = old.Find(this->Removed);
  const int a = old.Next(at);
  const int b = old.Previous(at);
  // The other ring is Kept, b, c1 .. ck, a. Replace Removed by c1 .. ck.
  Ring ring;
  for (int i = 0; i < at; ++i)
  {
    ring.Item[ring.Count++] = old.Item[i];
  }
  const int from = other.Find(b);
  for (int i = 1; i < other.Count; ++i)
  {
    const int c = other.Item[(from + i) % other.Count];
    if (c == a)
    {
      break;
    }
    ring.Item[ring.Count++] = c;
    mesh.Rings[c].Replace(this->Removed, this->Kept);
  }
  for (int i = at + 1; i < old.Count; ++i)
  {
    ring.Item[ring.Count++] = old.Item[i];
  }
  mesh.Rings[a].Remove(this->Removed);
  mesh.Rings[b].Remove(this->Removed);
  mesh.Rings[this->Kept] = ring;
  mesh.RemoveVertex(this->Removed, slots);
}
}
