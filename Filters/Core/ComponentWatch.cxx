// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentWatch.h"

#include <algorithm>
#include <cstddef>

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

/** From a vertex of a component along x: how many faces of the other components it crosses. */
struct Ray
{
  int Vertex;
  VectorD Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** Whether the face crosses the ray, seen along x. */
bool Crosses(const Ray& ray, const VectorD& a, const VectorD& b, const VectorD& c)
{
  const auto side = [&ray](const VectorD& p, const VectorD& q)
  {
    return (q.Y - p.Y) * (ray.Origin.Z - p.Z) - (q.Z - p.Z) * (ray.Origin.Y - p.Y);
  };
  const double u = side(b, c);
  const double v = side(c, a);
  const double w = side(a, b);
  const bool inside = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
  return inside && (u * a.X + v * b.X + w * c.X) / (u + v + w) > ray.Origin.X;
}

/** Counts the faces that have v as their smallest vertex. `rays` is sorted by Y. */
void CountCrossings(const SurfaceMesh& mesh, const std::vector<int>& labels, int v,
  const std::vector<Ray>& rays, std::vector<int>& crossings)
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
        ++crossings[ray - rays.begin()];
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
  std::vector<int>& parent = state.Component;
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
        doomed = doomed && (positive ? state.Value[v] < 0 : state.Value[v] > 0);
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
  if (this->Components < 2)
  {
    return false;
  }
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
    // A little beside the vertex, so that no ray meets an edge of its own grid.
    const VectorD beside(0., 1.3e-4 * state.Delta, 2.7e-4 * state.Delta);
    rays.push_back({ first[label], VectorD(mesh.Position[first[label]]) + beside,
      volumes[label] < 0. });
  }
  std::sort(rays.begin(), rays.end(),
    [](const Ray& a, const Ray& b) { return a.Origin.Y < b.Origin.Y; });
  constexpr std::size_t size = 8192;
  std::vector<std::vector<int>> crossings((mesh.Rings.size() + size - 1) / size);
  ForBlocks(executor, mesh.Rings.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      crossings[b].assign(rays.size(), 0);
      for (std::size_t v = begin; v < end; ++v)
      {
        if (mesh.IsAlive(static_cast<int>(v)))
        {
          CountCrossings(mesh, state.Component, static_cast<int>(v), rays, crossings[b]);
        }
      }
    });
  bool deleted = false;
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    int sum = 0;
    for (const std::vector<int>& block : crossings)
    {
      sum += block[i];
    }
    if ((sum % 2 == 1) != rays[i].IsCavity)
    {
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
