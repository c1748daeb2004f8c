// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ComponentWatch.h"

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
/** Up to this many they are nothing any more. */
constexpr int NothingSize = 5;

/** From a vertex of a component along x. */
struct Ray
{
  int Vertex;
  VectorD Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** A ray that a face of another component crosses. */
struct Crossing
{
  int Ray;
  int Component;
};

/**
 * Whether a ray along x passes to the right of an edge, seen along x. Of the two ends of an edge
 * only one counts, and both its faces get the same answer, so that the line of a ray meets a closed
 * surface an even number of times, even where it runs through edges and corners.
 */
bool PassesRight(const VectorD& origin, const VectorD& p, const VectorD& q)
{
  if ((p.Y > origin.Y) == (q.Y > origin.Y))
  {
    return false;
  }
  const VectorD& low = p.Y > origin.Y ? q : p;
  const VectorD& high = p.Y > origin.Y ? p : q;
  return (high.Y - low.Y) * (origin.Z - low.Z) < (high.Z - low.Z) * (origin.Y - low.Y);
}

/** Whether the face crosses the ray. */
bool Crosses(const Ray& ray, const VectorD& a, const VectorD& b, const VectorD& c)
{
  const VectorD& o = ray.Origin;
  if ((PassesRight(o, a, b) + PassesRight(o, b, c) + PassesRight(o, c, a)) % 2 == 0)
  {
    return false;
  }
  const VectorD normal = Cross(b - a, c - a);
  // The height of the origin over the face, along x; a face along the ray has no inside.
  const double height = Dot(normal, a - o);
  return normal.X > 0 ? height > 0 : height < 0;
}

/** Finds the crossings with the faces that have v as their smallest vertex. `rays`: by Y. */
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
    const VectorD a(mesh.Position[v]);
    const VectorD b(mesh.Position[second]);
    const VectorD c(mesh.Position[third]);
    const double low = std::min({ a.Y, b.Y, c.Y });
    const double high = std::max({ a.Y, b.Y, c.Y });
    auto ray = std::lower_bound(rays.begin(), rays.end(), low,
      [](const Ray& r, double y) { return r.Origin.Y < y; });
    for (; ray != rays.end() && ray->Origin.Y <= high; ++ray)
    {
      if (labels[ray->Vertex] != labels[v] && Crosses(*ray, a, b, c))
      {
        crossings.push_back({ static_cast<int>(ray - rays.begin()), labels[v] });
      }
    }
  }
}
}

double SignedVolume(const SurfaceMesh& mesh, const std::vector<int>& vertices)
{
  double sum = 0;
  const VectorD origin(mesh.Position[vertices.front()]);
  for (int v : vertices)
  {
    const Ring& ring = mesh.Rings[v];
    const VectorD p = VectorD(mesh.Position[v]) - origin;
    for (int i = 0; i < ring.Count; ++i)
    {
      sum += Dot(p, Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
                      VectorD(mesh.Position[ring.Next(i)]) - origin));
    }
  }
  return sum / 18.;
}

void ComponentWatch::Label(SurfaceState& state, Executor& executor)
{
  // Trees of vertices, each linked to a smaller one, in the place of the labels: first within
  // blocks, side by side, then across their borders.
  const std::size_t n = state.Mesh.Rings.size();
  std::vector<int>& parent = state.Component.AsVector();
  const auto root = [&parent](int v)
  {
    while (parent[v] != v)
    {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  };
  constexpr std::size_t size = 16384;
  this->Borders.resize((n + size - 1) / size);
  ForBlocks(executor, n, size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      this->Borders[b].clear();
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        parent[v] = v;
        int own = v;
        const Ring& ring = state.Mesh.Rings[v];
        for (int i = 0; i < ring.Count; ++i)
        {
          const int w = ring.Item[i];
          if (w < static_cast<int>(begin))
          {
            this->Borders[b].emplace_back(v, w);
          }
          else if (w < v)
          {
            const int other = root(w);
            parent[std::max(own, other)] = std::min(own, other);
            own = std::min(own, other);
          }
        }
      }
    });
  for (const auto& border : this->Borders)
  {
    for (const auto& edge : border)
    {
      const int a = root(edge.first);
      const int b = root(edge.second);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  this->Roots.resize(n);
  executor.For(n, 4096,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        int at = parent[v];
        while (parent[at] != at)
        {
          at = parent[at];
        }
        this->Roots[v] = at;
      }
    });
  this->Sizes.clear();
  for (int v = 0; v < static_cast<int>(n); ++v)
  {
    // Roots are the smallest of their component, so they bear their label already.
    if (!state.Mesh.IsAlive(v))
    {
      parent[v] = -1;
      continue;
    }
    if (this->Roots[v] == v)
    {
      parent[v] = static_cast<int>(this->Sizes.size());
      this->Sizes.push_back(0);
    }
    parent[v] = parent[this->Roots[v]];
    ++this->Sizes[parent[v]];
  }
  this->Components = static_cast<int>(this->Sizes.size());
  this->Smalls.clear();
  for (int& place : this->Sizes)
  {
    // From here on: the place among the small ones, or -1.
    const bool small = place <= SmallSize;
    place = small ? static_cast<int>(this->Smalls.size()) : -1;
    if (small)
    {
      this->Smalls.emplace_back();
      this->Smalls.back().Label = static_cast<int>(&place - this->Sizes.data());
    }
  }
  if (this->Smalls.empty())
  {
    return;
  }
  for (int v = 0; v < static_cast<int>(n); ++v)
  {
    const int place = parent[v] >= 0 ? this->Sizes[parent[v]] : -1;
    if (place >= 0)
    {
      this->Smalls[place].Vertices.push_back(v);
    }
  }
  for (Small& small : this->Smalls)
  {
    small.Positive = SignedVolume(state.Mesh, small.Vertices) > 0;
  }
}

bool ComponentWatch::DeleteDoomed(SurfaceState& state)
{
  bool deleted = false;
  for (Small& small : this->Smalls)
  {
    // Collapses and splits change the vertices of a component without a new label.
    int seed = -1;
    for (int v : small.Vertices)
    {
      // A place that was given up may belong to a vertex of another component now.
      if (state.Mesh.IsAlive(v) && state.Component[v] == small.Label)
      {
        seed = v;
        break;
      }
    }
    if (seed < 0)
    {
      continue;
    }
    this->Stack.assign(1, seed);
    state.Component[seed] = -2;
    for (std::size_t i = 0; i < this->Stack.size(); ++i)
    {
      const Ring& ring = state.Mesh.Rings[this->Stack[i]];
      for (int k = 0; k < ring.Count; ++k)
      {
        if (state.Component[ring.Item[k]] != -2)
        {
          state.Component[ring.Item[k]] = -2;
          this->Stack.push_back(ring.Item[k]);
        }
      }
    }
    for (int v : this->Stack)
    {
      state.Component[v] = small.Label;
    }
    if (this->Stack.size() > 2 * SmallSize)
    {
      small.Vertices.clear(); // It has grown.
      continue;
    }
    small.Vertices = this->Stack;
    const bool positive = SignedVolume(state.Mesh, small.Vertices) > 0;
    bool doomed = positive != small.Positive ||
      static_cast<int>(small.Vertices.size()) <= NothingSize;
    if (!doomed && static_cast<int>(small.Vertices.size()) <= TinySize)
    {
      doomed = true;
      for (int v : small.Vertices)
      {
        doomed = doomed && (positive ? state.FieldValue[v] < 0 : state.FieldValue[v] > 0);
      }
    }
    if (doomed)
    {
      // The labels of the others stay as they are.
      state.RemoveComponent(seed);
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
  const SurfaceMesh& mesh = state.Mesh;
  std::vector<double> volumes(this->Components, 0.);
  std::vector<int> first(this->Components, -1);
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (!mesh.IsAlive(v))
    {
      continue;
    }
    const int label = state.Component[v];
    if (first[label] < 0)
    {
      first[label] = v;
    }
    const VectorD origin(mesh.Position[first[label]]);
    const Ring& ring = mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      if (v < ring.Item[i] && v < ring.Next(i))
      {
        volumes[label] += Dot(VectorD(mesh.Position[v]) - origin,
          Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
            VectorD(mesh.Position[ring.Next(i)]) - origin));
      }
    }
  }
  std::vector<Ray> rays;
  for (int label = 0; label < this->Components; ++label)
  {
    rays.push_back(
      { first[label], VectorD(mesh.Position[first[label]]), volumes[label] < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const Ray& a, const Ray& b)
    { return a.Origin.Y != b.Origin.Y ? a.Origin.Y < b.Origin.Y : a.Vertex < b.Vertex; });
  constexpr std::size_t size = 8192;
  std::vector<std::vector<Crossing>> crossings((mesh.Rings.size() + size - 1) / size);
  ForBlocks(executor, mesh.Rings.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (mesh.IsAlive(static_cast<int>(v)))
        {
          FindCrossings(mesh, state.Component.AsVector(), static_cast<int>(v), rays, crossings[b]);
        }
      }
    });
  // Around a component are those that its ray crosses an odd number of times.
  std::vector<std::vector<int>> around(rays.size());
  for (const std::vector<Crossing>& block : crossings)
  {
    for (const Crossing& crossing : block)
    {
      around[crossing.Ray].push_back(crossing.Component);
    }
  }
  for (std::vector<int>& labels : around)
  {
    std::sort(labels.begin(), labels.end());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < labels.size();)
    {
      if (i + 1 < labels.size() && labels[i] == labels[i + 1])
      {
        i += 2;
        continue;
      }
      labels[kept++] = labels[i++];
    }
    labels.resize(kept);
  }
  // From outside in: what is deleted encloses nothing any more.
  std::vector<int> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&around](int a, int b) { return around[a].size() < around[b].size(); });
  std::vector<char> isGone(rays.size(), 0); // By label.
  bool deleted = false;
  for (int i : order)
  {
    const auto depth = std::count_if(around[i].begin(), around[i].end(),
      [&isGone](int label) { return !isGone[label]; });
    if ((depth % 2 == 1) != rays[i].IsCavity)
    {
      isGone[state.Component[rays[i].Vertex]] = 1;
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
