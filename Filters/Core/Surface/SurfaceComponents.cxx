// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceComponents.h"

#include "Core/Common/Box.h"
#include "Core/Common/DisjointSets.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/ComponentWatch.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::size_t JoinedSpan = 4096;

void JoinNeighbours(const SurfaceMesh& mesh, DisjointSets& joined, Executor& executor)
{
  ForSpans(executor, mesh.Rings.size(), JoinedSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        // Consecutive neighbours are adjacent: one of each run of smaller ones suffices.
        const Ring& ring = mesh.Rings[v];
        bool wasSmaller = false;
        for (int i = 0; i < ring.Count; ++i)
        {
          const bool isSmaller = ring.Item[i] < v;
          if (isSmaller && !wasSmaller)
          {
            joined.Join(v, ring.Item[i]);
          }
          wasSmaller = isSmaller;
        }
      }
    });
}

/**
 * Label alive vertices by connected component, from 0, in the order of the smallest vertices,
 * others with NoVertex. O(vertices). Return the smallest vertex of each label.
 */
std::vector<int> LabelConnected(
  const SurfaceMesh& mesh, LargeVector<int>& labels, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  DisjointSets joined(n);
  JoinNeighbours(mesh, joined, executor);
  std::vector<int> smallest = SelectIndices(executor, n,
    [&](std::size_t i)
    {
      const int v = static_cast<int>(i);
      return mesh.IsAlive(v) && joined.Find(v) == v;
    });
  for (std::size_t label = 0; label < smallest.size(); ++label)
  {
    labels[smallest[label]] = static_cast<int>(label);
  }
  ForSpans(executor, n, JoinedSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        const int root = mesh.IsAlive(v) ? joined.Find(v) : NoVertex;
        if (v != root) // Other threads read the label of the root.
        {
          labels[v] = root == NoVertex ? NoVertex : labels[root];
        }
      }
    });
  return smallest;
}

constexpr std::size_t CrossedSpan = 8192;

Point PointAt(const Vector& p)
{
  return { p.X, p.Y, p.Z };
}

/** Ray along x from the first vertex of a component. */
struct ComponentRay
{
  int Root;
  int Label;
  Point Origin;
  bool IsCavity; ///< Its volume is negative.
};

/** Label and volume of its faces in a span. */
using PartialVolume = std::pair<int, double>;

/** Return the volumes by label of the faces whose smallest vertex is in a range. */
std::vector<PartialVolume> VolumesOf(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<Vector>& origins, std::size_t begin, std::size_t end)
{
  std::vector<PartialVolume> volumes;
  std::unordered_map<int, std::size_t> slots;
  std::size_t slot = 0;
  mesh.VisitFaces(begin, end,
    [&](int a, int b, int c)
    {
      const int label = labels[a];
      if (volumes.empty() || volumes[slot].first != label)
      {
        const auto found = slots.emplace(label, volumes.size());
        slot = found.first->second;
        if (found.second)
        {
          volumes.emplace_back(label, 0.);
        }
      }
      volumes[slot].second += SignedVolume::OfFace(mesh, VectorD(origins[label]), a, b, c);
    });
  return volumes;
}

/** Return the volumes of all labels, each about its own origin. */
std::vector<double> VolumesOfFaces(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<Vector>& origins, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<PartialVolume>> spans((n + CrossedSpan - 1) / CrossedSpan);
  ForSpans(executor, n, CrossedSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    { spans[b] = VolumesOf(mesh, labels, origins, begin, end); });
  std::vector<double> volumes(origins.size(), 0.);
  for (const std::vector<PartialVolume>& ofSpan : spans)
  {
    for (const PartialVolume& volume : ofSpan)
    {
      volumes[volume.first] += volume.second;
    }
  }
  return volumes;
}

/** Return a ray per component, sorted by y. */
std::vector<ComponentRay> CastRays(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  std::vector<Vector> origins;
  for (const int root : roots)
  {
    origins.push_back(mesh.Position[root]);
  }
  const std::vector<double> volumes = VolumesOfFaces(mesh, labels, origins, executor);
  std::vector<ComponentRay> rays;
  for (std::size_t label = 0; label < roots.size(); ++label)
  {
    rays.push_back(
      { roots[label], static_cast<int>(label), PointAt(origins[label]), volumes[label] < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const ComponentRay& a, const ComponentRay& b)
    { return a.Origin[1] != b.Origin[1] ? a.Origin[1] < b.Origin[1] : a.Root < b.Root; });
  return rays;
}

/**
 * Find the components that are inside out, see DeleteInsideOut(), with rays along x. O(n + pairs of
 * ray and triangle that overlap). The result does not depend on the executor.
 * @param labels of vertices, from 0
 * @param roots a vertex of each label
 * @return roots of these components, those enclosed by fewer components first
 */
std::vector<int> FindInsideOut(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  const std::vector<ComponentRay> rays = CastRays(mesh, labels, roots, executor);
  std::vector<Point> origins;
  std::vector<int> own;
  for (const ComponentRay& ray : rays)
  {
    origins.push_back(ray.Origin);
    own.push_back(ray.Label);
  }
  const std::vector<std::vector<int>> enclosing = EnclosingComponents(
    origins, own, mesh.Rings.size(),
    [&](std::size_t begin, std::size_t end, const auto& visit)
    {
      mesh.VisitFaces(begin, end,
        [&](int a, int b, int c)
        {
          visit(PointAt(mesh.Position[a]), PointAt(mesh.Position[b]), PointAt(mesh.Position[c]),
            labels[a]);
        });
    },
    executor);
  // From outside in: components that are inside out enclose nothing.
  std::vector<int> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&enclosing](int a, int b) { return enclosing[a].size() < enclosing[b].size(); });
  std::vector<char> isInsideOut(rays.size(), 0); // By label.
  std::vector<int> found;
  for (int i : order)
  {
    const auto depth = std::count_if(enclosing[i].begin(), enclosing[i].end(),
      [&isInsideOut](int label) { return !isInsideOut[label]; });
    if ((depth % 2 == 1) != rays[i].IsCavity)
    {
      isInsideOut[rays[i].Label] = 1;
      found.push_back(rays[i].Root);
    }
  }
  return found;
}
}

void SurfaceComponents::Label(SurfaceState& state, Executor& executor)
{
  LargeVector<int>& labels = state.Component.AsVector();
  this->Roots = LabelConnected(state.Mesh, labels, executor);
  this->Sizes.assign(this->Roots.size(), 0);
  for (const int label : labels)
  {
    if (label != NoVertex)
    {
      ++this->Sizes[label];
    }
  }
  this->Edits = EditCounts();
}

bool SurfaceComponents::DeleteDegenerate(SurfaceState& state, Executor& executor)
{
  constexpr float far = 1e9f;
  ComponentWatch watch;
  watch.LabelSmall(
    state, 0, state.Mesh.Size(), { Vector(-far, -far, -far), Vector(far, far, far) });
  const bool deleted = watch.DeleteDegenerate(state);
  this->Label(state, executor); // The watch has changed labels.
  return deleted;
}

bool SurfaceComponents::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<int> insideOut =
    FindInsideOut(state.Mesh, state.Component.AsVector(), this->Roots, executor);
  for (const int root : insideOut)
  {
    state.RemoveComponent(root);
  }
  if (!insideOut.empty())
  {
    this->Label(state, executor);
  }
  return !insideOut.empty();
}
}
