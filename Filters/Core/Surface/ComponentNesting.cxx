// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentNesting.h"

#include "Core/Common/ExactSum.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Spans.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SurfaceMeasures.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace volumic
{
namespace
{
/** Vertices that one thread looks for crossings at at a time. */
constexpr std::size_t CrossedSpan = 8192;

Point PointAt(const Vector& p)
{
  return { p.X, p.Y, p.Z };
}

/** From the first vertex of a component along x. */
struct ComponentRay
{
  int Root;
  int Label;
  Point Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** A ray that another component crosses an odd number of times. */
struct RayCrossing
{
  int Ray; ///< Its place among the rays.
  int Label;
  bool operator<(const RayCrossing& other) const
  {
    return this->Ray != other.Ray ? this->Ray < other.Ray : this->Label < other.Label;
  }
};

/** Faces of one label in a span. */
using PartialVolume = std::pair<int, ExactSum>;

/** Of the faces whose smallest vertex is in a range, by label. */
std::vector<PartialVolume> VolumesOf(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<Vector>& origins, std::size_t begin, std::size_t end)
{
  std::vector<PartialVolume> volumes;
  std::unordered_map<int, std::size_t> places;
  std::size_t place = 0;
  mesh.VisitFaces(begin, end,
    [&](int a, int b, int c)
    {
      const int label = labels[a];
      if (volumes.empty() || volumes[place].first != label)
      {
        const auto found = places.emplace(label, volumes.size());
        place = found.first->second;
        if (found.second)
        {
          volumes.emplace_back(label, ExactSum());
        }
      }
      volumes[place].second.Add(SignedVolume::OfFace(mesh, VectorD(origins[label]), a, b, c));
    });
  return volumes;
}

/** Leaves those that there are an odd number of, sorted, each once. */
void KeepOdd(std::vector<RayCrossing>& crossings)
{
  std::sort(crossings.begin(), crossings.end());
  std::size_t count = 0; // Of those that no equal one has met yet.
  for (const RayCrossing& crossing : crossings)
  {
    if (count > 0 && !(crossings[count - 1] < crossing))
    {
      --count;
    }
    else
    {
      crossings[count++] = crossing;
    }
  }
  crossings.resize(count);
}

/** Finds the crossings with the faces that have v as their smallest vertex. */
void AddCrossings(const SurfaceMesh& mesh, int v, int component,
  const std::vector<ComponentRay>& rays, std::vector<RayCrossing>& crossings)
{
  const Ring& ring = mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int second = ring.Item[i];
    const int third = ring.Next(i);
    if (second < v || third < v)
    {
      continue;
    }
    const Point a = PointAt(mesh.Position[v]);
    const Point b = PointAt(mesh.Position[second]);
    const Point c = PointAt(mesh.Position[third]);
    const double low = std::min({ a[1], b[1], c[1] });
    const double high = std::max({ a[1], b[1], c[1] });
    auto ray = std::lower_bound(rays.begin(), rays.end(), low,
      [](const ComponentRay& r, double y) { return r.Origin[1] < y; });
    for (; ray != rays.end() && ray->Origin[1] <= high; ++ray)
    {
      if (ray->Label == component)
      {
        continue;
      }
      const RowCrossing crossing = RowCrossing::Of(a, b, c, ray->Origin[1], ray->Origin[2]);
      if (crossing.Winding != 0 && crossing.X > ray->Origin[0])
      {
        crossings.push_back({ static_cast<int>(ray - rays.begin()), component });
      }
    }
  }
}

/** The volumes of all labels; each seen from a place of its own. */
std::vector<ExactSum> VolumesOfFaces(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<Vector>& origins, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<PartialVolume>> spans((n + CrossedSpan - 1) / CrossedSpan);
  ForSpans(executor, n, CrossedSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    { spans[b] = VolumesOf(mesh, labels, origins, begin, end); });
  std::vector<ExactSum> volumes(origins.size());
  for (const std::vector<PartialVolume>& ofSpan : spans)
  {
    for (const PartialVolume& volume : ofSpan)
    {
      volumes[volume.first].Add(volume.second);
    }
  }
  return volumes;
}

/** A ray of each component, by Y. */
std::vector<ComponentRay> CastRays(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  std::vector<Vector> places;
  for (const int root : roots)
  {
    places.push_back(mesh.Position[root]);
  }
  const std::vector<ExactSum> volumes = VolumesOfFaces(mesh, labels, places, executor);
  std::vector<ComponentRay> rays;
  for (std::size_t label = 0; label < roots.size(); ++label)
  {
    rays.push_back({ roots[label], static_cast<int>(label), PointAt(places[label]),
      volumes[label].Value() < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const ComponentRay& a, const ComponentRay& b)
    { return a.Origin[1] != b.Origin[1] ? a.Origin[1] < b.Origin[1] : a.Root < b.Root; });
  return rays;
}

/** Of the faces with the rays of other components, sorted. */
std::vector<RayCrossing> FindCrossings(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<ComponentRay>& rays, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<RayCrossing>> spans((n + CrossedSpan - 1) / CrossedSpan);
  ForSpans(executor, n, CrossedSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        AddCrossings(mesh, v, labels[v], rays, spans[b]);
      }
      KeepOdd(spans[b]);
    });
  std::vector<RayCrossing> crossings = Joined(executor, spans);
  KeepOdd(crossings);
  return crossings;
}

}

std::vector<int> FindInsideOut(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  const std::vector<ComponentRay> rays = CastRays(mesh, labels, roots, executor);
  // The labels of the components around the origin of each ray.
  std::vector<std::vector<int>> around(rays.size());
  for (const RayCrossing& crossing : FindCrossings(mesh, labels, rays, executor))
  {
    around[crossing.Ray].push_back(crossing.Label);
  }
  // From outside in: what is inside out encloses nothing.
  std::vector<int> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&around](int a, int b) { return around[a].size() < around[b].size(); });
  std::vector<char> isInsideOut(rays.size(), 0); // By label.
  std::vector<int> found;
  for (int i : order)
  {
    const auto depth = std::count_if(around[i].begin(), around[i].end(),
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
