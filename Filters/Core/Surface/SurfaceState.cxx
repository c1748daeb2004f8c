// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceState.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Surface/StarShape.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time: 20 microseconds. */
constexpr std::size_t ShapeGrain = 128;
constexpr std::size_t AliveGrain = 1 << 14;
/** So many free places behind a forgotten vertex may be given back with its own. */
constexpr int FreeRun = 256;

/** @param take called for each vertex, with its position, before the mesh has it */
template <typename Take>
std::vector<int> ReadVertices(MessageReader& message, SurfaceMesh& mesh, const Take& take)
{
  const std::vector<int> vertices = message.TakeVector<int>();
  const std::vector<Vector> positions = message.TakeVector<Vector>();
  const std::vector<int> rings = message.TakeVector<int>();
  std::size_t next = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const int v = vertices[i];
    take(v, positions[i]);
    Ring& ring = mesh.Rings[v];
    ring.Count = rings[next++];
    std::copy_n(rings.begin() + static_cast<std::ptrdiff_t>(next), ring.Count, ring.Item);
    next += static_cast<std::size_t>(ring.Count);
    mesh.Position[v] = positions[i];
  }
  return vertices;
}
}

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
  this->Grid.Reset(low, high, this->Sizing.SmallestReach());
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

void SurfaceState::ForgetMotion()
{
  for (VertexProperty<Vector>* property : { &this->Velocity, &this->PreviousPosition,
         &this->Anchor, &this->Laplacian, &this->SpringPull })
  {
    property->Remake(0);
  }
  for (VertexProperty<float>* property :
    { &this->FieldValue, &this->Displacement, &this->Drift, &this->Slack })
  {
    property->Remake(0);
  }
}

void SurfaceState::ForgetAllButMesh()
{
  this->Properties.Remake(0);
  this->Grid.Reset(Vector(), Vector(), 1.f);
}

void SurfaceState::Prefetch(int first, int last) const
{
  const auto count = static_cast<std::size_t>(last - first);
  PrefetchLarge(this->Mesh.Position.data() + first, count * sizeof(Vector));
  PrefetchLarge(this->Mesh.Rings.data() + first, count * sizeof(Ring));
  this->Properties.Prefetch(static_cast<std::size_t>(first), static_cast<std::size_t>(last));
}

UnusedPlaces SurfaceState::AddUnusedPlaces(int n, Executor& executor)
{
  const UnusedPlaces places = this->Mesh.AddUnusedPlaces(n);
  this->Properties.Lengthen(static_cast<std::size_t>(places.End), executor);
  this->Grid.Lengthen(static_cast<std::size_t>(places.End));
  return places;
}

void SurfaceState::Remake(std::size_t n, int vertices, const Vector& low, const Vector& high)
{
  this->Mesh.Remake(n, vertices);
  this->Properties.Remake(n);
  this->Grid.Reset(low, high, this->Sizing.SmallestReach());
  this->Grid.Lengthen(n);
}

void SurfaceState::WriteMesh(
  const SurfaceMesh& mesh, MessageWriter& message, const std::vector<int>& vertices)
{
  message.AddArray(vertices);
  std::vector<Vector> positions;
  std::vector<int> rings; // The number of neighbours, then these, one after the other.
  positions.reserve(vertices.size());
  for (const int v : vertices)
  {
    positions.push_back(mesh.Position[v]);
    const Ring& ring = mesh.Rings[v];
    rings.push_back(ring.Count);
    rings.insert(rings.end(), ring.Item, ring.Item + ring.Count);
  }
  message.AddArray(positions);
  message.AddArray(rings);
}

void SurfaceState::ReadMesh(MessageReader& message, SurfaceMesh& mesh)
{
  ReadVertices(message, mesh, [](int, const Vector&) {});
}

void SurfaceState::Write(MessageWriter& message, const std::vector<int>& vertices) const
{
  WriteMesh(this->Mesh, message, vertices);
  this->Properties.Write(message, vertices);
}

std::vector<std::uint64_t> SurfaceState::HashesOf(const std::vector<int>& vertices) const
{
  std::vector<std::uint64_t> hashes;
  hashes.reserve(vertices.size());
  for (const int v : vertices)
  {
    const Ring& ring = this->Mesh.Rings[v];
    std::uint64_t hash = AddValue(0, this->Mesh.Position[v]);
    for (int k = 0; k < ring.Count; ++k)
    {
      hash = AddValue(hash, ring.Item[k]);
    }
    hashes.push_back(AddValue(hash, ring.Count));
  }
  this->Properties.AddTo(hashes, vertices);
  return hashes;
}

std::vector<int> SurfaceState::Read(MessageReader& message)
{
  std::vector<int> vertices = this->ReadConnectivity(message);
  this->Properties.Read(message, vertices);
  return vertices;
}

std::vector<int> SurfaceState::ReadMesh(MessageReader& message)
{
  std::vector<int> vertices = this->ReadConnectivity(message);
  this->Properties.Initialise(vertices, OnThisThread());
  for (const int v : vertices)
  {
    this->PreviousPosition[v] = this->Anchor[v] = this->Mesh.Position[v];
  }
  return vertices;
}

std::vector<int> SurfaceState::AddPiece(
  const SurfaceMesh& mesh, int first, const std::vector<int>& vertices, Executor& executor)
{
  std::vector<int> added(vertices.size());
  ForSpans(executor, vertices.size(), AliveGrain,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = vertices[i];
        added[i] = first + v;
        Ring& ring = this->Mesh.Rings[added[i]];
        ring = mesh.Rings[v];
        std::for_each(ring.Item, ring.Item + ring.Count, [first](int& w) { w += first; });
        this->Mesh.Position[added[i]] = mesh.Position[v];
      }
    });
  this->Grid.InsertAll(
    this->Mesh.Position, static_cast<std::size_t>(first),
    [this](int v) { return this->Mesh.IsAlive(v); }, executor);
  this->Properties.Initialise(added, executor);
  for (const int v : added)
  {
    this->PreviousPosition[v] = this->Anchor[v] = this->Mesh.Position[v];
  }
  return added;
}

std::vector<int> SurfaceState::ReadConnectivity(MessageReader& message)
{
  return ReadVertices(message, this->Mesh,
    [this](int v, const Vector& position)
    {
      if (this->Mesh.IsAlive(v))
      {
        this->Grid.Move(v, position);
      }
      else
      {
        this->Grid.Insert(v, position);
      }
    });
}

void SurfaceState::Forget(int v)
{
  if (this->Mesh.IsAlive(v))
  {
    this->RemoveVertex(v);
    this->Mesh.Rings[v].Count = 0; // Its place is another rank's.
  }
}

void SurfaceState::GiveBack(std::vector<int> forgotten)
{
  std::sort(forgotten.begin(), forgotten.end());
  for (auto next = forgotten.begin(); next != forgotten.end();)
  {
    const int first = *next;
    int end = first; // On to what is alive, or to where nothing was.
    for (int last = first; end < std::min(this->Mesh.Size(), last + FreeRun) &&
         !this->Mesh.IsAlive(end);
         ++end)
    {
      if (next != forgotten.end() && *next == end)
      {
        last = end;
        ++next;
      }
    }
    const auto count = static_cast<std::size_t>(end - first);
    GiveBackPages(this->Mesh.Position.data() + first, count * sizeof(Vector));
    GiveBackPages(this->Mesh.Rings.data() + first, count * sizeof(Ring));
    this->Properties.Forget(static_cast<std::size_t>(first), static_cast<std::size_t>(end));
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
    const Lanes hugest =
      ofEdges([&](int w) { return this->Sizing.LongestEdge(v, w, HugeEdge); });
    const Lanes shortest = ofEdges([&](int w) { return this->Sizing.ShortestEdge(v, w); });
    pull.Set(
      i, star.Edge.At(i) * (Lanes(1.f) - rest / Maximum(length, Lanes(1e-6f) * rest)));
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
  const float share = 1.f / static_cast<float>(star.Count);
  this->Laplacian[v] = star.Edge.Sum(star.Count) * share;
  this->Laplacian[v].Padding = share;
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

SurfaceState::RemovedComponent SurfaceState::TakeComponentAway(int v, VertexPlaces* places)
{
  // The ring of a removed vertex is kept aside as it is emptied; -1 in Component marks visits.
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
    this->Mesh.RemoveVertex(w, places);
  }
  // V - E + F with 2 E = 3 F, which is the sum of the valences.
  const int vertices = static_cast<int>(stack.size());
  return { vertices, vertices - static_cast<int>(ends / 6) };
}

int SurfaceState::RemoveComponent(int v)
{
  const RemovedComponent removed = this->TakeComponentAway(v, nullptr);
  this->EulerCharacteristic -= removed.EulerCharacteristic;
  ++this->Counts.Removed;
  this->Counts.RemovedGenus += 1 - removed.EulerCharacteristic / 2;
  return removed.Vertices;
}
}
