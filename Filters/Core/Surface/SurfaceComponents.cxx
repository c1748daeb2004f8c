// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceComponents.h"

#include "Core/Common/Box.h"
#include "Core/Surface/ComponentNesting.h"
#include "Core/Surface/ComponentWatch.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
/** All that a small component is judged by. */
struct VertexRecord
{
  int Vertex;
  float FieldValue;
  Vector Position;
  volumic::Ring Ring;
};

/** A surface of these vertices alone, in the same order. */
void Fill(SurfaceState& state, const std::vector<VertexRecord>& records)
{
  const auto placeOf = [&records](int v)
  {
    const auto found = std::lower_bound(records.begin(), records.end(), v,
      [](const VertexRecord& record, int vertex) { return record.Vertex < vertex; });
    return static_cast<int>(found - records.begin());
  };
  Vector low = records.front().Position;
  Vector high = low;
  for (const VertexRecord& record : records)
  {
    Ring ring = record.Ring;
    for (int i = 0; i < ring.Count; ++i)
    {
      ring.Item[i] = placeOf(ring.Item[i]);
    }
    state.Mesh.Position.push_back(record.Position);
    state.Mesh.Rings.push_back(ring);
    low = Minimum(low, record.Position);
    high = Maximum(high, record.Position);
  }
  state.Reset(low, high);
  for (std::size_t v = 0; v < records.size(); ++v)
  {
    state.FieldValue[v] = records[v].FieldValue;
  }
}

/** Of components those that must go, by their smallest vertices. @param records by vertex */
std::vector<int> FindDegenerate(const std::vector<VertexRecord>& records, const SizingField& sizing)
{
  std::vector<int> found;
  if (records.empty())
  {
    return found;
  }
  SurfaceState state;
  state.Sizing = SizingField(sizing.OfLevel()); // Its vertices have other numbers.
  Fill(state, records);
  constexpr float far = 1e9f;
  ComponentWatch watch;
  watch.LabelSmall(
    state, 0, state.Mesh.Size(), { Vector(-far, -far, -far), Vector(far, far, far) });
  std::vector<int> roots; // By component; they come in order.
  for (int v = 0; v < static_cast<int>(records.size()); ++v)
  {
    if (roots.empty() || state.Component[v] > state.Component[roots.back()])
    {
      roots.push_back(v);
    }
  }
  watch.DeleteDegenerate(state);
  for (const int root : roots)
  {
    if (!state.Mesh.IsAlive(root))
    {
      found.push_back(records[root].Vertex);
    }
  }
  return found;
}
}

void SurfaceComponents::Label(SurfaceState& state, Executor& executor)
{
  this->Connected.Label(state.Mesh, state.Component.AsVector(), executor);
  this->Components = static_cast<int>(this->Connected.Roots().size());
}

bool SurfaceComponents::DeleteDegenerate(SurfaceState& state)
{
  std::vector<VertexRecord> small;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (state.Mesh.IsAlive(v) &&
      this->Connected.Sizes()[state.Component[v]] <= ComponentWatch::SmallSize)
    {
      small.push_back({ v, state.FieldValue[v], state.Mesh.Position[v], state.Mesh.Rings[v] });
    }
  }
  const std::vector<int> found = FindDegenerate(small, state.Sizing);
  this->Remove(state, found);
  return !found.empty();
}

std::vector<int> SurfaceComponents::FindInsideOut(
  const SurfaceState& state, Executor& executor) const
{
  const LargeVector<int>& labels = state.Component.AsVector();
  const std::vector<int>& roots = this->Connected.Roots();
  std::vector<Vector> places;
  for (const int root : roots)
  {
    places.push_back(state.Mesh.Position[root]);
  }
  const std::vector<ComponentRay> rays =
    CastRays(roots, places, VolumesOfFaces(state.Mesh, labels, places, executor));
  return JudgeFromOutsideIn(rays, FindCrossings(state.Mesh, labels, rays, executor));
}

bool SurfaceComponents::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<int> insideOut = this->FindInsideOut(state, executor);
  this->Remove(state, insideOut);
  if (!insideOut.empty())
  {
    this->Label(state, executor);
  }
  return !insideOut.empty();
}

void SurfaceComponents::Remove(SurfaceState& state, const std::vector<int>& roots)
{
  if (roots.empty())
  {
    return;
  }
  std::vector<char> isRemoved(this->Connected.Roots().size(), 0); // By label.
  for (const int root : roots)
  {
    isRemoved[state.Component[root]] = 1;
  }
  std::vector<std::int64_t> neighbours(isRemoved.size(), 0);
  std::vector<int> vertices(isRemoved.size(), 0);
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    const int label = state.Component[v];
    if (state.Mesh.IsAlive(v) && isRemoved[label])
    {
      ++vertices[label];
      neighbours[label] += state.Mesh.Rings[v].Count;
      state.RemoveVertex(v);
      state.Mesh.RemoveVertex(v);
    }
  }
  for (const int root : roots)
  {
    const int label = state.Component[root];
    const int characteristic = vertices[label] - static_cast<int>(neighbours[label] / 6);
    state.EulerCharacteristic -= characteristic;
    ++state.Counts.Removed;
    state.Counts.RemovedGenus += 1 - characteristic / 2;
  }
  this->Components -= static_cast<int>(roots.size());
}
}
