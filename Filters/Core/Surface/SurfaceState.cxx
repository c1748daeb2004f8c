// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceState.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Surface/StarShape.h"

#include <algorithm>
#include <numeric>

namespace volumic
{
namespace
{
/** Vertices per task: 20 microseconds. */
constexpr std::size_t ShapeGrain = 128;
constexpr std::size_t AliveGrain = 1 << 14;
}

void SurfaceState::Reset(const Vector& low, const Vector& high)
{
  this->Reset(low, high, OnThisThread());
}

void SurfaceState::Reset(const Vector& low, const Vector& high, Executor& executor)
{
  this->Properties.Reset(this->Mesh.Rings.size(), executor);
  this->PreviousPosition.Assign(this->Mesh.Position);
  this->Anchor.Assign(this->Mesh.Position);
  this->Grid.Reset(low, high, this->Sizing.SmallestSearchRadius());
  this->Grid.InsertAll(
    this->Mesh.Position, 0, [this](int v) { return this->Mesh.IsAlive(v); }, executor);
  executor.For(static_cast<std::size_t>(this->Mesh.Size()), AliveGrain,
    [this](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        this->Active[v] = this->Mesh.IsAlive(v) ? 1 : 0;
      }
    });
  this->EulerCharacteristic = this->Mesh.CountEulerCharacteristic(executor);
}

void SurfaceState::ReleaseMotion()
{
  for (VertexProperty<Vector>* property : { &this->Velocity, &this->PreviousPosition, &this->Anchor,
         &this->Laplacian, &this->SpringPull })
  {
    property->Release();
  }
  for (VertexProperty<float>* property :
    { &this->FieldValue, &this->Displacement, &this->MotionSinceTest, &this->ClearanceAtTest })
  {
    property->Release();
  }
}

void SurfaceState::Reorder(
  const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor)
{
  // Properties that are used only within passes serve as buffers.
  const auto swapBuffers = [&]
  {
    this->PreviousPosition.AsVector().swap(buffers.ReorderBuffer<Vector>::Values);
    this->Displacement.AsVector().swap(buffers.ReorderBuffer<float>::Values);
    this->Marks.AsVector().swap(buffers.ReorderBuffer<std::uint8_t>::Values);
  };
  swapBuffers();
  this->Mesh.Reorder(order, buffers, executor);
  this->Properties.Reorder(order, buffers, executor);
  swapBuffers();
  this->PreviousPosition.Reset(order.size());
  this->Displacement.Reset(order.size());
  this->Marks.Reset(order.size());
  this->Grid.Clear();
  this->Grid.InsertAll(
    this->Mesh.Position, 0, [&order](int v) { return order[v] != NoVertex; }, executor);
}

void SurfaceState::Append(const IndexedSurface& surface, Executor& executor)
{
  this->EulerCharacteristic +=
    static_cast<int>(surface.Points.size()) - static_cast<int>(surface.Triangles.size() / 2);
  const int first = this->Mesh.Append(surface, executor);
  this->Properties.Resize(this->Mesh.Rings.size());
  this->Grid.InsertAll(
    this->Mesh.Position, static_cast<std::size_t>(first), [](int) { return true; }, executor);
  std::vector<int> vertices(surface.Points.size());
  std::iota(vertices.begin(), vertices.end(), first);
  for (const int v : vertices)
  {
    this->PreviousPosition[v] = this->Anchor[v] = this->Mesh.Position[v];
  }
  this->UpdateShape(vertices, executor);
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

void SurfaceState::UpdateShape(int v)
{
  const StarShape star(this->Mesh, v);
  StarVectors pull;
  unsigned tooLong = 0;
  unsigned tooShort = 0;
  unsigned huge = 0;
  for (int i = 0; i < star.Count; i += Lanes::Count)
  {
    const auto ofEdges = [&](auto&& of)
    {
      float four[Lanes::Count];
      for (int k = 0; k < Lanes::Count; ++k)
      {
        four[k] = of(i + k < star.Count ? star.Item[i + k] : v);
      }
      return Lanes::Load(four);
    };
    const Lanes length = star.Length.At(i);
    const Lanes rest = ofEdges([&](int w) { return this->Sizing.RestLength(v, w); });
    const Lanes longest = ofEdges([&](int w) { return this->Sizing.LongestEdge(v, w); });
    const Lanes hugest = ofEdges([&](int w) { return this->Sizing.LongestEdge(v, w, HugeEdge); });
    const Lanes shortest = ofEdges([&](int w) { return this->Sizing.ShortestEdge(v, w); });
    pull.Set(i, star.Edge.At(i) * (Lanes(1.f) - rest / Maximum(length, Lanes(1e-6f) * rest)));
    tooLong |= LessBits(longest, length) << i;
    huge |= LessBits(hugest, length) << i;
    tooShort |= LessBits(length, shortest) << i;
  }
  float edges = 0;
  for (int i = 0; i < star.Count; ++i)
  {
    edges += star.Length[i];
  }
  std::uint8_t flags = 0;
  flags |= tooLong & star.All() ? HasLongEdge : 0;
  flags |= tooShort & star.All() ? HasShortEdge : 0;
  flags |= huge & star.All() ? HasHugeEdge : 0;
  flags |= star.IsDelaunay() ? 0 : IsNotDelaunay;
  this->Normal[v] = star.Cone();
  const float weight = 1.f / static_cast<float>(star.Count);
  this->Laplacian[v] = star.Edge.Sum(star.Count) * weight;
  this->Laplacian[v].Padding = weight;
  this->SpringPull[v] = pull.Sum(star.Count);
  this->EdgeLengthSum[v] = edges;
  this->RemeshFlags[v] = flags;
}

void SurfaceState::UpdateShape(const std::vector<int>& vertices, Executor& executor)
{
  executor.For(vertices.size(), ShapeGrain,
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

SurfaceState::RemovedComponent SurfaceState::EraseComponent(int v, VertexSlots* slots)
{
  // The ring is copied, as removal empties it. Component is -1 for visited vertices.
  std::vector<int> stack(1, v);
  std::int64_t ends = 0;
  this->Component[v] = -1;
  for (std::size_t i = 0; i < stack.size(); ++i)
  {
    const Ring ring = this->Mesh.Rings[stack[i]];
    ends += ring.Count;
    for (int k = 0; k < ring.Count; ++k)
    {
      const int w = ring.Item[k];
      if (this->Component[w] != -1)
      {
        this->Component[w] = -1;
        stack.push_back(w);
      }
    }
  }
  for (const int w : stack)
  {
    this->RemoveVertex(w);
    this->Mesh.RemoveVertex(w, slots);
  }
  // V - E + F with 2 E = 3 F, where 2 E is the sum of the valences.
  const int vertices = static_cast<int>(stack.size());
  return { vertices, vertices - static_cast<int>(ends / 6) };
}

int SurfaceState::RemoveComponent(int v)
{
  const RemovedComponent removed = this->EraseComponent(v, nullptr);
  this->EulerCharacteristic -= removed.EulerCharacteristic;
  ++this->Counts.Removed;
  return removed.Vertices;
}
}
