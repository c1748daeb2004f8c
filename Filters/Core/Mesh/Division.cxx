// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/Division.h"

namespace volumic
{
KeptEdges::KeptEdges(const SurfaceMesh& mesh) : Mesh(mesh), FirstSlot(mesh.Rings.size() + 1, 0)
{
  for (int v = 0; v < mesh.Size(); ++v)
  {
    this->FirstSlot[v + 1] = this->FirstSlot[v] + mesh.Rings[v].Count;
  }
  this->Flags.assign(static_cast<std::size_t>(this->FirstSlot.back()), 0);
}

void KeptEdges::Keep(int u, int v)
{
  this->Flags[this->FirstSlot[u] + this->Mesh.Rings[u].Find(v)] = 1;
  this->Flags[this->FirstSlot[v] + this->Mesh.Rings[v].Find(u)] = 1;
}

void KeptEdges::KeepAllAt(int v)
{
  for (int i = 0; i < this->Mesh.Rings[v].Count; ++i)
  {
    this->Keep(v, this->Mesh.Rings[v].Item[i]);
  }
}

void KeptEdges::MakeRoom()
{
  // Each run of kept edges adds a neighbour; with all of them kept there are as many as before.
  for (bool changed = true; changed;)
  {
    changed = false;
    for (int v = 0; v < this->Mesh.Size(); ++v)
    {
      const int count = this->Mesh.Rings[v].Count;
      int runs = 0;
      for (int i = 0; i < count; ++i)
      {
        runs += this->Has(v, i) && !this->HasAfter(v, i);
      }
      if (count + runs > Ring::Capacity)
      {
        this->KeepAllAt(v);
        changed = true;
      }
    }
  }
}

namespace
{
/** The new vertices about the old ones, by the slots of those: slot i of v names v's edge i. */
struct NewVertices
{
  std::vector<int> FirstSlot;
  std::vector<int> Centre; ///< Of face (v, ring[i], ring[i + 1]).
  std::vector<int> Middle; ///< Of the edge, -1: it is flipped.
};

void Append(Ring& ring, int vertex)
{
  if (vertex >= 0)
  {
    ring.Item[ring.Count++] = vertex;
  }
}
}

std::vector<std::array<int, 3>> Divide(SurfaceMesh& mesh, const KeptEdges* kept)
{
  const int olds = mesh.Size();
  NewVertices news;
  news.FirstSlot.assign(olds + 1, 0);
  for (int v = 0; v < olds; ++v)
  {
    news.FirstSlot[v + 1] = news.FirstSlot[v] + mesh.Rings[v].Count;
  }
  news.Centre.assign(news.FirstSlot[olds], -1);
  const auto slot = [&](int v, int neighbour)
  { return news.FirstSlot[v] + mesh.Rings[v].Find(neighbour); };
  std::vector<std::array<int, 3>> faces;
  faces.reserve(news.Centre.size() / 3);
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
        faces.push_back({ v, b, c });
        news.Centre[news.FirstSlot[v] + i] = number;
        news.Centre[slot(b, c)] = number;
        news.Centre[slot(c, v)] = number;
      }
    }
  }
  int count = olds + static_cast<int>(faces.size());
  mesh.Position.reserve(count);
  for (const std::array<int, 3>& face : faces)
  {
    mesh.Position.push_back(
      (mesh.Position[face[0]] + mesh.Position[face[1]] + mesh.Position[face[2]]) * (1.f / 3.f));
  }
  news.Middle.assign(news.Centre.size(), -1);
  std::vector<std::array<int, 2>> edges;
  for (int v = 0; kept && v < olds; ++v)
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i)
    {
      const int w = mesh.Rings[v].Item[i];
      if (v < w && kept->Has(v, i))
      {
        edges.push_back({ v, w });
        mesh.Position.push_back((mesh.Position[v] + mesh.Position[w]) * 0.5f);
        news.Middle[news.FirstSlot[v] + i] = news.Middle[slot(w, v)] = count++;
      }
    }
  }
  mesh.Rings.resize(count);
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    // Corner, then what lies across the edge to the next corner.
    Ring& ring = mesh.Rings[olds + f];
    for (int k = 0; k < 3; ++k)
    {
      const int a = faces[f][k];
      const int b = faces[f][(k + 1) % 3];
      const int c = faces[f][(k + 2) % 3];
      const int middle = news.Middle[slot(a, b)];
      const bool isCut = middle >= 0 && news.Middle[slot(a, c)] >= 0;
      Append(ring, isCut ? -1 : a);
      Append(ring, middle >= 0 ? middle : news.Centre[slot(b, a)]);
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const int u = edges[e][0];
    const int v = edges[e][1];
    const int left = mesh.Rings[u].After(v);
    const int right = mesh.Rings[u].Before(v);
    Ring& ring = mesh.Rings[olds + faces.size() + e];
    Append(ring, u);
    Append(ring, news.Middle[slot(u, right)]);
    Append(ring, news.Centre[slot(v, u)]);
    Append(ring, news.Middle[slot(v, right)]);
    Append(ring, v);
    Append(ring, news.Middle[slot(v, left)]);
    Append(ring, news.Centre[slot(u, v)]);
    Append(ring, news.Middle[slot(u, left)]);
  }
  for (int v = 0; v < olds; ++v)
  {
    Ring ring;
    const int first = news.FirstSlot[v];
    const int n = mesh.Rings[v].Count;
    for (int i = 0; i < n; ++i)
    {
      const bool isCut =
        news.Middle[first + i] >= 0 && news.Middle[first + (i + 1 < n ? i + 1 : 0)] >= 0;
      Append(ring, news.Middle[first + i]);
      Append(ring, isCut ? -1 : news.Centre[first + i]);
    }
    mesh.Rings[v] = ring;
  }
  return faces;
}

SurfaceMesh Undivided(const SurfaceMesh& mesh, int olds)
{
  SurfaceMesh old;
  old.Position.assign(mesh.Position.begin(), mesh.Position.begin() + olds);
  old.Rings.resize(olds);
  for (int v = 0; v < olds; ++v)
  {
    // The edge between the centres of two faces at v was flipped from v and the other vertex there.
    const Ring& ring = mesh.Rings[v];
    old.Rings[v].Count = ring.Count;
    for (int i = 0; i < ring.Count; ++i)
    {
      old.Rings[v].Item[i] = mesh.Rings[ring.Item[i]].After(ring.Previous(i));
    }
  }
  return old;
}
}
