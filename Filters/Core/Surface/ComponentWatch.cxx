// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentWatch.h"

#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SurfaceMeasures.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
/** Components up to this many vertices are watched. */
constexpr int SmallSize = 400;
/** Up to this many they are deleted when wholly on the wrong side. */
constexpr int TinySize = 24;
/** Up to this many they have vanished. */
constexpr int VanishedSize = 5;

/** Vertices that one thread joins, or looks for crossings at, at a time. */
constexpr std::size_t JoinedBlock = 16384;
constexpr std::size_t CrossedBlock = 8192;
/** Vertices under which a chunk is not worth a thread. */
constexpr std::size_t Grain = 4096;

/** What DeleteDegenerate has seen of a component, in the place of its label. */
constexpr int Seen = -2;

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

bool IsVolumePositive(const SurfaceMesh& mesh, const std::vector<int>& vertices)
{
  SignedVolume volume(mesh.Position[vertices.front()]);
  for (int v : vertices)
  {
    volume.Add(mesh, v);
  }
  return volume.Value() > 0;
}

/** A ray from the first vertex of each component, by Y. `labels`: of the vertices. */
std::vector<Ray> CastRays(const SurfaceMesh& mesh, const std::vector<int>& labels, int components)
{
  std::vector<SignedVolume> volumes(components);
  std::vector<int> first(components, -1);
  mesh.VisitFaces(
    [&](int a, int b, int c)
    {
      // The first face of a component has its smallest vertex.
      const int label = labels[a];
      if (first[label] < 0)
      {
        first[label] = a;
        volumes[label] = SignedVolume(mesh.Position[a]);
      }
      volumes[label].AddFace(mesh, a, b, c);
    });
  std::vector<Ray> rays;
  for (int label = 0; label < components; ++label)
  {
    rays.push_back({ first[label], PositionOf(mesh, first[label]), volumes[label].Value() < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const Ray& a, const Ray& b)
    { return a.Origin[1] != b.Origin[1] ? a.Origin[1] < b.Origin[1] : a.Vertex < b.Vertex; });
  return rays;
}

/** Finds the crossings with the faces that have v as their smallest vertex. */
void FindCrossings(const SurfaceMesh& mesh, const std::vector<int>& labels, int v,
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
  const std::vector<int>& labels, const std::vector<Ray>& rays, Executor& executor)
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

void ComponentWatch::Label(SurfaceState& state, Executor& executor)
{
  this->JoinVertices(state.Mesh, executor);
  executor.For(state.Mesh.Rings.size(), Grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        state.Component[v] = this->Joined.FindRoot(v);
      }
    });
  std::vector<int> sizes;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (!state.Mesh.IsAlive(v))
    {
      state.Component[v] = -1;
      continue;
    }
    // Roots are the smallest of their component, so they bear their label already.
    const int root = state.Component[v];
    const int label = root == v ? static_cast<int>(sizes.size()) : state.Component[root];
    if (root == v)
    {
      sizes.push_back(0);
    }
    state.Component[v] = label;
    ++sizes[label];
  }
  this->Components = static_cast<int>(sizes.size());
  this->WatchSmallOnes(state, sizes);
}

void ComponentWatch::JoinVertices(const SurfaceMesh& mesh, Executor& executor)
{
  // First within blocks, side by side, then across their borders.
  const std::size_t n = mesh.Rings.size();
  this->Joined.Resize(n);
  this->Borders.resize((n + JoinedBlock - 1) / JoinedBlock);
  ForBlocks(executor, n, JoinedBlock,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      this->Borders[b].clear();
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        this->Joined.MakeSet(v);
        int root = v;
        const Ring& ring = mesh.Rings[v];
        for (int i = 0; i < ring.Count; ++i)
        {
          const int w = ring.Item[i];
          if (w < static_cast<int>(begin))
          {
            this->Borders[b].emplace_back(v, w);
          }
          else if (w < v)
          {
            root = this->Joined.Join(root, w);
          }
        }
      }
    });
  for (const auto& border : this->Borders)
  {
    for (const auto& edge : border)
    {
      this->Joined.Join(edge.first, edge.second);
    }
  }
}

void ComponentWatch::WatchSmallOnes(const SurfaceState& state, const std::vector<int>& sizes)
{
  this->Watched.clear();
  std::vector<int> place(sizes.size(), -1); // Among those that are watched, by label.
  for (std::size_t label = 0; label < sizes.size(); ++label)
  {
    if (sizes[label] <= SmallSize)
    {
      place[label] = static_cast<int>(this->Watched.size());
      this->Watched.emplace_back();
      this->Watched.back().Label = static_cast<int>(label);
    }
  }
  if (this->Watched.empty())
  {
    return;
  }
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    const int label = state.Component[v];
    if (label >= 0 && place[label] >= 0)
    {
      this->Watched[place[label]].Vertices.push_back(v);
    }
  }
  for (SmallComponent& small : this->Watched)
  {
    small.IsPositive = IsVolumePositive(state.Mesh, small.Vertices);
  }
}

bool ComponentWatch::FindVertices(SurfaceState& state, const SmallComponent& small)
{
  // Collapses and splits change the vertices of a component without a new label. A place that was
  // given up may belong to a vertex of another component now.
  const auto seed = std::find_if(small.Vertices.begin(), small.Vertices.end(),
    [&](int v) { return state.Mesh.IsAlive(v) && state.Component[v] == small.Label; });
  if (seed == small.Vertices.end())
  {
    return false;
  }
  this->Stack.assign(1, *seed);
  state.Component[*seed] = Seen;
  for (std::size_t i = 0; i < this->Stack.size(); ++i)
  {
    const Ring& ring = state.Mesh.Rings[this->Stack[i]];
    for (int k = 0; k < ring.Count; ++k)
    {
      if (state.Component[ring.Item[k]] != Seen)
      {
        state.Component[ring.Item[k]] = Seen;
        this->Stack.push_back(ring.Item[k]);
      }
    }
  }
  for (int v : this->Stack)
  {
    state.Component[v] = small.Label;
  }
  return true;
}

bool ComponentWatch::DeleteDegenerate(SurfaceState& state)
{
  bool deleted = false;
  for (SmallComponent& small : this->Watched)
  {
    if (!this->FindVertices(state, small))
    {
      continue;
    }
    if (this->Stack.size() > 2 * SmallSize)
    {
      small.Vertices.clear(); // It has grown.
      continue;
    }
    small.Vertices = this->Stack;
    const int size = static_cast<int>(small.Vertices.size());
    const bool positive = IsVolumePositive(state.Mesh, small.Vertices);
    const auto isOnWrongSide = [&](int v)
    { return positive ? state.FieldValue[v] < 0 : state.FieldValue[v] > 0; };
    if (positive != small.IsPositive || size <= VanishedSize ||
      (size <= TinySize &&
        std::all_of(small.Vertices.begin(), small.Vertices.end(), isOnWrongSide)))
    {
      // The labels of the others stay as they are.
      state.RemoveComponent(small.Vertices.front());
      small.Vertices.clear();
      --this->Components;
      deleted = true;
    }
  }
  return deleted;
}

bool ComponentWatch::DeleteInsideOut(SurfaceState& state, Executor& executor)
{
  this->Label(state, executor);
  const std::vector<Ray> rays = CastRays(state.Mesh, state.Component.AsVector(), this->Components);
  const std::vector<std::vector<int>> around =
    ComponentsAround(state.Mesh, state.Component.AsVector(), rays, executor);
  // From outside in: what is deleted encloses nothing any more.
  std::vector<int> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&around](int a, int b) { return around[a].size() < around[b].size(); });
  std::vector<char> isDeleted(rays.size(), 0); // By label.
  bool deleted = false;
  for (int i : order)
  {
    const auto depth = std::count_if(
      around[i].begin(), around[i].end(), [&isDeleted](int label) { return !isDeleted[label]; });
    if ((depth % 2 == 1) != rays[i].IsCavity)
    {
      isDeleted[state.Component[rays[i].Vertex]] = 1;
      state.RemoveComponent(rays[i].Vertex);
      deleted = true;
    }
  }
  if (deleted)
  {
    this->Label(state, executor);
  }
  return deleted;
}
}
