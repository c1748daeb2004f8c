// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceState.h"

#include <algorithm>

namespace volumic
{
void SurfaceState::Reset(const Vector& low, const Vector& high)
{
  SequentialExecutor thread;
  this->Reset(low, high, thread);
}

void SurfaceState::Reset(const Vector& low, const Vector& high, Executor& executor)
{
  this->Properties.Reset(this->Mesh.Rings.size(), executor);
  this->PreviousPosition.Assign(this->Mesh.Position);
  this->Anchor.Assign(this->Mesh.Position);
  this->LongestEdge = 0;
  this->Grid.Reset(low, high, this->Sizing.LargestReach());
  this->Grid.InsertAll(
    this->Mesh.Position, [this](int v) { return this->Mesh.IsAlive(v); }, executor);
  for (int v = 0; v < this->Mesh.Size(); ++v)
  {
    this->Active[v] = this->Mesh.IsAlive(v) ? 1 : 0;
  }
  this->EulerCharacteristic = this->Mesh.CountEulerCharacteristic();
}

void SurfaceState::Lend(VertexPlaces& places, std::size_t n)
{
  const std::size_t before = this->Mesh.Rings.size();
  this->Mesh.Lend(places, n);
  this->Properties.Resize(this->Mesh.Rings.size());
  this->Grid.Resize(this->Mesh.Rings.size());
  for (std::size_t v = before; v < this->Mesh.Rings.size(); ++v)
  {
    this->Active[v] = 0; // Until there is a vertex.
  }
}

void SurfaceState::AddVertex(int v, int parent)
{
  this->Properties.Add(v, parent);
  this->Anchor[v] = this->Mesh.Position[v];
  this->Grid.Insert(v, this->Mesh.Position[v]);
}

void SurfaceState::RemoveVertex(int v)
{
  this->Grid.Remove(v);
  this->Active[v] = 0;
  this->EdgeLengthSum[v] = 0;
}

namespace
{
/** A star as UpdateShape sees it: its edges, counter-clockwise, and the faces between them. */
struct StarShape
{
  int Count = 0;
  Vector Edge[Ring::Capacity];
  float Length[Ring::Capacity];
  Vector Normal[Ring::Capacity]; ///< Of face i, between the edges i and i + 1.
  float Size[Ring::Capacity];    ///< Twice its area.

  StarShape(const SurfaceMesh& mesh, int v)
    : Count(mesh.Rings[v].Count)
  {
    const Ring& ring = mesh.Rings[v];
    const Vector p = mesh.Position[v];
    for (int i = 0; i < this->Count; ++i)
    {
      this->Edge[i] = mesh.Position[ring.Item[i]] - p;
      this->Length[i] = volumic::Length(this->Edge[i]);
    }
    for (int i = 0; i < this->Count; ++i)
    {
      this->Normal[i] = Cross(this->Edge[i], this->Edge[this->After(i)]);
      this->Size[i] = volumic::Length(this->Normal[i]);
    }
  }
  int After(int i) const { return i + 1 < this->Count ? i + 1 : 0; }

  NormalCone Cone() const
  {
    Vector sum;
    for (int i = 0; i < this->Count; ++i)
    {
      sum += this->Normal[i];
    }
    const Vector axis = Normalized(sum);
    float cosine = 1;
    for (int i = 0; i < this->Count; ++i)
    {
      cosine = std::min(
        cosine, this->Size[i] > 0 ? Dot(this->Normal[i], axis) / this->Size[i] : -1.f);
    }
    return NormalCone(axis, cosine);
  }

  /** Whether the angles opposite to each edge exceed 180 degrees by no more than a little. */
  bool IsDelaunay() const
  {
    constexpr float least = LeastCotangentSum;
    for (int i = 0; i < this->Count; ++i)
    {
      const int before = i > 0 ? i - 1 : this->Count - 1;
      const int after = this->After(i);
      const float a =
        this->Length[before] * this->Length[before] - Dot(this->Edge[before], this->Edge[i]);
      const float b =
        this->Length[after] * this->Length[after] - Dot(this->Edge[after], this->Edge[i]);
      // a / size[before] + b / size[i] < least, free of divisions
      if (a * this->Size[i] + b * this->Size[before] < least * this->Size[i] * this->Size[before])
      {
        return false;
      }
    }
    return true;
  }
};
}

void SurfaceState::UpdateShape(int v)
{
  const StarShape star(this->Mesh, v);
  const Ring& ring = this->Mesh.Rings[v];
  Vector laplacian;
  Vector spring;
  float edges = 0;
  std::uint8_t flags = 0;
  for (int i = 0; i < star.Count; ++i)
  {
    const int w = ring.Item[i];
    const float rest = this->Sizing.RestLength(v, w);
    laplacian += star.Edge[i];
    spring += star.Edge[i] * (1 - rest / std::max(star.Length[i], 1e-6f * rest));
    edges += star.Length[i];
    flags |= star.Length[i] > this->Sizing.LongestEdge(v, w) ? HasLongEdge : 0;
    flags |= star.Length[i] < this->Sizing.ShortestEdge(v, w) ? HasShortEdge : 0;
    flags |= star.Length[i] > this->Sizing.LongestEdge(v, w, HugeEdge) ? HasHugeEdge : 0;
  }
  laplacian *= 1.f / static_cast<float>(star.Count);
  this->Normal[v] = star.Cone();
  this->Laplacian[v] = laplacian;
  this->SpringPull[v] = spring;
  this->EdgeLengthSum[v] = edges;
  this->RemeshFlags[v] = star.IsDelaunay() ? flags : flags | IsNotDelaunay;
}

void SurfaceState::UpdateShape(const std::vector<int>& vertices, Executor& executor)
{
  executor.For(vertices.size(), 512,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (this->Mesh.IsAlive(vertices[i]))
        {
          this->UpdateShape(vertices[i]);
        }
      }
    });
}

int SurfaceState::RemoveComponent(int v)
{
  this->Stack.assign(1, v);
  // The ring of a removed vertex is kept aside as it is emptied; -1 in Component marks visits.
  int vertices = 0;
  std::int64_t ends = 0;
  this->Component[v] = -1;
  for (std::size_t i = 0; i < this->Stack.size(); ++i)
  {
    const Ring ring = this->Mesh.Rings[this->Stack[i]];
    ends += ring.Count;
    ++vertices;
    for (int k = 0; k < ring.Count; ++k)
    {
      const int w = ring.Item[k];
      if (this->Component[w] != -1)
      {
        this->Component[w] = -1;
        this->Stack.push_back(w);
      }
    }
  }
  for (int w : this->Stack)
  {
    this->RemoveVertex(w);
    this->Mesh.RemoveVertex(w);
  }
  // V - E + F with 2 E = 3 F, which is the sum of the valences.
  const int characteristic = vertices - static_cast<int>(ends / 6);
  this->EulerCharacteristic -= characteristic;
  ++this->Counts.Removed;
  this->Counts.RemovedGenus += 1 - characteristic / 2;
  return vertices;
}
}
