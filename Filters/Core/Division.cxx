// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Division.h"

namespace volumic
{
int Divide(SurfaceMesh& mesh)
{
  const int olds = mesh.Size();
  // Slot i of vertex v names the face (v, ring[i], ring[i + 1]).
  std::vector<int> firstSlot(olds + 1, 0);
  for (int v = 0; v < olds; ++v)
  {
    firstSlot[v + 1] = firstSlot[v] + mesh.Rings[v].Count;
  }
  std::vector<int> centre(firstSlot[olds], -1);
  struct Face
  {
    int Corner[3];
  };
  std::vector<Face> faces;
  faces.reserve(centre.size() / 3);
  for (int v = 0; v < olds; ++v)
  {
    const Ring& ring = mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int b = ring.Item[i];
      const int c = ring.Next(i);
      if (v < b && v < c)
      {
        const int number = olds + static_cast<int>(faces.size());
        faces.push_back({ { v, b, c } });
        centre[firstSlot[v] + i] = number;
        centre[firstSlot[b] + mesh.Rings[b].Find(c)] = number;
        centre[firstSlot[c] + mesh.Rings[c].Find(v)] = number;
      }
    }
  }
  mesh.Position.reserve(olds + faces.size());
  mesh.Rings.resize(olds + faces.size());
  const auto centreAt = [&](int v, int neighbour) // of the face to the left of v -> neighbour
  { return centre[firstSlot[v] + mesh.Rings[v].Find(neighbour)]; };
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const int a = faces[f].Corner[0];
    const int b = faces[f].Corner[1];
    const int c = faces[f].Corner[2];
    mesh.Position.push_back(
      (mesh.Position[a] + mesh.Position[b] + mesh.Position[c]) * (1.f / 3.f));
    Ring& ring = mesh.Rings[olds + f];
    ring.Count = 6;
    ring.Item[0] = a;
    ring.Item[1] = centreAt(b, a);
    ring.Item[2] = b;
    ring.Item[3] = centreAt(c, b);
    ring.Item[4] = c;
    ring.Item[5] = centreAt(a, c);
  }
  for (int v = 0; v < olds; ++v)
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i)
    {
      mesh.Rings[v].Item[i] = centre[firstSlot[v] + i];
    }
  }
  return olds;
}
}
