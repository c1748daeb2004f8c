// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceState.h"

namespace volumic
{
void SurfaceState::Reset(const Vector& low, const Vector& high)
{
  const std::size_t n = this->Mesh.Rings.size();
  this->Velocity.assign(n, Vector());
  this->Normal.assign(n, Vector());
  this->Pull.assign(n, Vector());
  this->Spring.assign(n, Vector());
  this->Before = this->Mesh.Position;
  this->Anchor = this->Mesh.Position;
  this->Value.assign(n, 0.f);
  this->EdgeSum.assign(n, 0.f);
  this->Moved.assign(n, 0.f);
  this->Drift.assign(n, 0.f);
  this->Slack.assign(n, 0.f);
  this->Slow.assign(n, 1);
  this->Component.assign(n, 0);
  this->Awake.assign(n, 1);
  this->Quiet.assign(n, 0);
  this->Stuck.assign(n, 0);
  this->Near.assign(n, 1);
  this->Wants.assign(n, 0);
  this->Touched.clear();
  this->Grid.Reset(low, high, constraint::Reach * this->Delta);
  for (int v = 0; v < this->Mesh.Size(); ++v)
  {
    if (this->Mesh.IsAlive(v))
    {
      this->Grid.Insert(v, this->Mesh.Position[v]);
    }
    else
    {
      this->Awake[v] = 0;
    }
  }
  this->EulerCharacteristic = this->Mesh.CountEulerCharacteristic();
}

void SurfaceState::Adopt(int v, int parent)
{
  if (v >= static_cast<int>(this->Velocity.size()))
  {
    const std::size_t n = v + 1;
    this->Velocity.resize(n);
    this->Normal.resize(n);
    this->Pull.resize(n);
    this->Spring.resize(n);
    this->Before.resize(n);
    this->Anchor.resize(n);
    this->Value.resize(n);
    this->EdgeSum.resize(n);
    this->Moved.resize(n);
    this->Drift.resize(n);
    this->Slack.resize(n);
    this->Slow.resize(n);
    this->Component.resize(n);
    this->Awake.resize(n);
    this->Quiet.resize(n);
    this->Stuck.resize(n);
    this->Near.resize(n);
    this->Wants.resize(n);
  }
  this->Velocity[v] = this->Velocity[parent];
  this->Normal[v] = this->Normal[parent];
  this->Pull[v] = Vector();
  this->Spring[v] = this->Spring[parent];
  this->Before[v] = this->Before[parent];
  this->Anchor[v] = this->Mesh.Position[v];
  this->Value[v] = this->Value[parent];
  this->EdgeSum[v] = 0;
  this->Moved[v] = 0;
  this->Drift[v] = 1e6f; // Not examined yet.
  this->Slack[v] = 0;
  this->Slow[v] = 0;
  this->Component[v] = this->Component[parent];
  this->Awake[v] = 1;
  this->Quiet[v] = 0;
  this->Stuck[v] = 0;
  this->Near[v] = this->Near[parent];
  this->Wants[v] = 0;
  this->Grid.Insert(v, this->Mesh.Position[v]);
}

void SurfaceState::Forget(int v)
{
  this->Grid.Remove(v);
  this->Awake[v] = 0;
  this->EdgeSum[v] = 0;
}

void SurfaceState::UpdateShape(int v)
{
  const Ring& ring = this->Mesh.Rings[v];
  const int count = ring.Count;
  const Vector p = this->Mesh.Position[v];
  Vector edge[Ring::Capacity];
  float length[Ring::Capacity];
  Vector face[Ring::Capacity];
  float size[Ring::Capacity];
  Vector pull;
  Vector spring;
  std::uint8_t wants = 0;
  const float rest = constraint::RestLength * this->Delta;
  for (int i = 0; i < count; ++i)
  {
    edge[i] = this->Mesh.Position[ring.Item[i]] - p;
    length[i] = Length(edge[i]);
    pull += edge[i];
    spring += edge[i] * (1 - rest / std::max(length[i], 1e-6f * rest));
    wants |= length[i] > constraint::LongestEdge * this->Delta ? Wish::Shorter : 0;
    wants |= length[i] < this->Delta ? Wish::Longer : 0;
  }
  float edges = 0;
  for (int i = 0; i < count; ++i)
  {
    edges += length[i];
  }
  this->EdgeSum[v] = edges;
  Vector sum;
  for (int i = 0; i < count; ++i)
  {
    face[i] = Cross(edge[i], edge[i + 1 < count ? i + 1 : 0]);
    size[i] = Length(face[i]);
    sum += face[i];
  }
  Vector normal = Normalized(sum);
  float cone = 1;
  for (int i = 0; i < count; ++i)
  {
    cone = std::min(cone, size[i] > 0 ? Dot(face[i], normal) / size[i] : -1.f);
  }
  // Delaunay: an edge should be flipped where the two angles opposite to it exceed 180 degrees,
  // that is where their cotangents add up to less than 0.
  for (int i = 0; i < count && !(wants & Wish::Flip); ++i)
  {
    const int before = i > 0 ? i - 1 : count - 1;
    const int after = i + 1 < count ? i + 1 : 0;
    const float a = length[before] * length[before] - Dot(edge[before], edge[i]);
    const float b = length[after] * length[after] - Dot(edge[after], edge[i]);
    // a / size[before] + b / size[i] < -0.05, free of divisions
    if (a * size[i] + b * size[before] < -0.05f * size[i] * size[before])
    {
      wants |= Wish::Flip;
    }
  }
  normal.Unused = cone;
  this->Normal[v] = normal;
  pull *= 1.f / static_cast<float>(count);
  float area = 0;
  for (int i = 0; i < count; ++i)
  {
    area += size[i];
  }
  pull.Unused = area * (1.f / 6.f);
  this->Pull[v] = pull;
  spring.Unused = 0;
  this->Spring[v] = spring;
  this->Wants[v] = wants;
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
    this->Forget(w);
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
