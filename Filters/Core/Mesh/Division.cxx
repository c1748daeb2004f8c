// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/Division.h"

#include <utility>

namespace volumic
{
EdgeSlots::EdgeSlots(const SurfaceMesh& mesh) : First(mesh.Rings.size() + 1, 0)
{
  for (int v = 0; v < mesh.Size(); ++v)
  {
    this->First[v + 1] = this->First[v] + mesh.Rings[v].Count;
  }
}

KeptEdges::KeptEdges(const SurfaceMesh& mesh) : Mesh(mesh), Slots(mesh), Flags(Slots.Count(), 0) {}

void KeptEdges::Keep(int u, int v)
{
  this->Flags[this->Slots.At(u, this->Mesh.Rings[u].Find(v))] = 1;
  this->Flags[this->Slots.At(v, this->Mesh.Rings[v].Find(u))] = 1;
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
constexpr int None = -1;

void Append(Ring& ring, int vertex)
{
  if (vertex != None)
  {
    ring.Item[ring.Count++] = vertex;
  }
}

/** A division at work. Rings of old vertices are those before it until they are replaced. */
class SqrtThreeDivision
{
public:
  SqrtThreeDivision(SurfaceMesh& mesh, const KeptEdges* kept)
    : Mesh(mesh), Kept(kept), OldVertices(mesh.Size()), Slots(mesh), Centre(Slots.Count(), None),
      Middle(Slots.Count(), None)
  {
    this->Faces.reserve(this->Centre.size() / 3);
  }

  std::vector<std::array<int, 3>> Run()
  {
    this->AddCentres();
    this->AddMiddles();
    this->Mesh.Rings.resize(this->Mesh.Position.size());
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      this->JoinCentre(f);
    }
    for (std::size_t e = 0; e < this->HalvedEdges.size(); ++e)
    {
      this->JoinMiddle(e);
    }
    for (int v = 0; v < this->OldVertices; ++v)
    {
      this->JoinOld(v);
    }
    return std::move(this->Faces);
  }

private:
  int Slot(int v, int neighbour) const
  {
    return this->Slots.At(v, this->Mesh.Rings[v].Find(neighbour));
  }

  void AddCentres();
  void AddMiddles();
  void JoinCentre(std::size_t face);
  void JoinMiddle(std::size_t edge);
  void JoinOld(int v);

  SurfaceMesh& Mesh;
  const KeptEdges* Kept;
  const int OldVertices;
  EdgeSlots Slots;
  std::vector<int> Centre; ///< New vertex of the face (v, ring[i], ring[i + 1]).
  std::vector<int> Middle; ///< New vertex of the edge; None: it is flipped.
  std::vector<std::array<int, 3>> Faces;
  std::vector<std::array<int, 2>> HalvedEdges;
};

void SqrtThreeDivision::AddCentres()
{
  for (int v = 0; v < this->OldVertices; ++v)
  {
    const Ring& ring = this->Mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int b = ring.Item[i];
      const int c = ring.Next(i);
      if (v < b && v < c)
      {
        const int number = this->OldVertices + static_cast<int>(this->Faces.size());
        this->Faces.push_back({ v, b, c });
        this->Centre[this->Slots.At(v, i)] = number;
        this->Centre[this->Slot(b, c)] = number;
        this->Centre[this->Slot(c, v)] = number;
      }
    }
  }
  std::vector<Vector>& position = this->Mesh.Position;
  position.reserve(position.size() + this->Faces.size());
  for (const std::array<int, 3>& face : this->Faces)
  {
    position.push_back((position[face[0]] + position[face[1]] + position[face[2]]) * (1.f / 3.f));
  }
}

void SqrtThreeDivision::AddMiddles()
{
  for (int v = 0; this->Kept && v < this->OldVertices; ++v)
  {
    const Ring& ring = this->Mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      if (v < w && this->Kept->Has(v, i))
      {
        const int number = static_cast<int>(this->Mesh.Position.size());
        this->HalvedEdges.push_back({ v, w });
        this->Mesh.Position.push_back((this->Mesh.Position[v] + this->Mesh.Position[w]) * 0.5f);
        this->Middle[this->Slots.At(v, i)] = this->Middle[this->Slot(w, v)] = number;
      }
    }
  }
}

void SqrtThreeDivision::JoinCentre(std::size_t face)
{
  // Corner, then what lies across the edge to the next corner.
  Ring& ring = this->Mesh.Rings[this->OldVertices + face];
  for (int k = 0; k < 3; ++k)
  {
    const int a = this->Faces[face][k];
    const int b = this->Faces[face][(k + 1) % 3];
    const int c = this->Faces[face][(k + 2) % 3];
    const int middle = this->Middle[this->Slot(a, b)];
    const bool isCutOff = middle != None && this->Middle[this->Slot(a, c)] != None;
    Append(ring, isCutOff ? None : a);
    Append(ring, middle != None ? middle : this->Centre[this->Slot(b, a)]);
  }
}

void SqrtThreeDivision::JoinMiddle(std::size_t edge)
{
  const int u = this->HalvedEdges[edge][0];
  const int v = this->HalvedEdges[edge][1];
  const int left = this->Mesh.Rings[u].After(v);
  const int right = this->Mesh.Rings[u].Before(v);
  Ring& ring = this->Mesh.Rings[this->OldVertices + this->Faces.size() + edge];
  Append(ring, u);
  Append(ring, this->Middle[this->Slot(u, right)]);
  Append(ring, this->Centre[this->Slot(v, u)]);
  Append(ring, this->Middle[this->Slot(v, right)]);
  Append(ring, v);
  Append(ring, this->Middle[this->Slot(v, left)]);
  Append(ring, this->Centre[this->Slot(u, v)]);
  Append(ring, this->Middle[this->Slot(u, left)]);
}

void SqrtThreeDivision::JoinOld(int v)
{
  Ring ring;
  const int count = this->Mesh.Rings[v].Count;
  for (int i = 0; i < count; ++i)
  {
    const int middle = this->Middle[this->Slots.At(v, i)];
    const bool isCutOff =
      middle != None && this->Middle[this->Slots.At(v, i + 1 < count ? i + 1 : 0)] != None;
    Append(ring, middle);
    Append(ring, isCutOff ? None : this->Centre[this->Slots.At(v, i)]);
  }
  this->Mesh.Rings[v] = ring;
}
}

std::vector<std::array<int, 3>> Divide(SurfaceMesh& mesh, const KeptEdges* kept)
{
  return SqrtThreeDivision(mesh, kept).Run();
}

SurfaceMesh Undivided(const SurfaceMesh& mesh, int numberOfVertices)
{
  SurfaceMesh old;
  old.Position.assign(mesh.Position.begin(), mesh.Position.begin() + numberOfVertices);
  old.Rings.resize(numberOfVertices);
  for (int v = 0; v < numberOfVertices; ++v)
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
