// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentNesting.h"

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
constexpr std::size_t CrossedBlock = 8192;

/** From a vertex of a component along x. */
struct Ray
{
  int Vertex;
  Point Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** A ray that a face of another component crosses. */
struct Crossing
{
  int Ray;
  int Component;
};

Point PositionOf(const SurfaceMesh& mesh, int v)
{
  const Vector& p = mesh.Position[v];
  return { p.X, p.Y, p.Z };
}

/** Faces of one component in a block. */
using PartialVolume = std::pair<int, SignedVolume>;

/** Of the faces whose smallest vertex is in a range, by label. `roots`: a vertex of each. */
std::vector<PartialVolume> VolumesOf(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, std::size_t begin, std::size_t end)
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
          volumes.emplace_back(label, SignedVolume(mesh.Position[roots[label]]));
        }
      }
      volumes[place].second.AddFace(mesh, a, b, c);
    });
  return volumes;
}

/**
 * A ray from the first vertex of each component, by Y. `labels`: of the vertices, `roots`: the
 * first vertex of each label.
 */
std::vector<Ray> CastRays(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<PartialVolume>> parts((n + CrossedBlock - 1) / CrossedBlock);
  ForBlocks(executor, n, CrossedBlock,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    { parts[b] = VolumesOf(mesh, labels, roots, begin, end); });
  std::vector<SignedVolume> volumes;
  for (const int root : roots)
  {
    volumes.emplace_back(mesh.Position[root]);
  }
  for (const std::vector<PartialVolume>& ofBlock : parts)
  {
    for (const PartialVolume& part : ofBlock)
    {
      volumes[part.first].Add(part.second);
    }
  }
  std::vector<Ray> rays;
  for (std::size_t label = 0; label < roots.size(); ++label)
  {
    rays.push_back(
      { roots[label], PositionOf(mesh, roots[label]), volumes[label].Value() < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const Ray& a, const Ray& b)
    { return a.Origin[1] != b.Origin[1] ? a.Origin[1] < b.Origin[1] : a.Vertex < b.Vertex; });
  return rays;
}

/** Finds the crossings with the faces that have v as their smallest vertex. */
void FindCrossings(const SurfaceMesh& mesh, const LargeVector<int>& labels, int v,
  const std::vector<Ray>& rays, std::vector<Crossing>& crossings)
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
    const Point a = PositionOf(mesh, v);
    const Point b = PositionOf(mesh, second);
    const Point c = PositionOf(mesh, third);
    const double low = std::min({ a[1], b[1], c[1] });
    const double high = std::max({ a[1], b[1], c[1] });
    auto ray = std::lower_bound(
      rays.begin(), rays.end(), low, [](const Ray& r, double y) { return r.Origin[1] < y; });
    for (; ray != rays.end() && ray->Origin[1] <= high; ++ray)
    {
      if (labels[ray->Vertex] == labels[v])
      {
        continue;
      }
      const RowCrossing crossing = RowCrossing::Of(a, b, c, ray->Origin[1], ray->Origin[2]);
      if (crossing.Winding != 0 && crossing.X > ray->Origin[0])
      {
        crossings.push_back({ static_cast<int>(ray - rays.begin()), labels[v] });
      }
    }
  }
}

/**
 * For each ray the labels of the components around its origin: those it crosses an odd number of
 * times.
 */
std::vector<std::vector<int>> ComponentsAround(const SurfaceMesh& mesh,
  const LargeVector<int>& labels, const std::vector<Ray>& rays, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  std::vector<std::vector<Crossing>> crossings((n + CrossedBlock - 1) / CrossedBlock);
  ForBlocks(executor, n, CrossedBlock,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        FindCrossings(mesh, labels, v, rays, crossings[b]);
      }
    });
  std::vector<std::vector<int>> around(rays.size());
  for (const std::vector<Crossing>& block : crossings)
  {
    for (const Crossing& crossing : block)
    {
      around[crossing.Ray].push_back(crossing.Component);
    }
  }
  for (std::vector<int>& crossed : around)
  {
    std::sort(crossed.begin(), crossed.end());
    std::vector<int> odd;
    for (int label : crossed)
    {
      if (!odd.empty() && odd.back() == label)
      {
        odd.pop_back();
      }
      else
      {
        odd.push_back(label);
      }
    }
    crossed.swap(odd);
  }
  return around;
}
}

std::vector<int> FindInsideOut(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor)
{
  const std::vector<Ray> rays = CastRays(mesh, labels, roots, executor);
  const std::vector<std::vector<int>> around = ComponentsAround(mesh, labels, rays, executor);
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
      isInsideOut[labels[rays[i].Vertex]] = 1;
      found.push_back(rays[i].Vertex);
    }
  }
  return found;
}
}
