// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentWatch.h"

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

void ComponentWatch::Label(SurfaceState& state)
{
  const int n = state.Mesh.Size();
  for (int v = 0; v < n; ++v)
  {
    state.Component[v] = -1;
  }
  this->Smalls.clear();
  this->Components = 0;
  for (int v = 0; v < n; ++v)
  {
    if (!state.Mesh.IsAlive(v) || state.Component[v] >= 0)
    {
      continue;
    }
    const int label = this->Components++;
    this->Stack.assign(1, v);
    state.Component[v] = label;
    for (std::size_t i = 0; i < this->Stack.size(); ++i)
    {
      const Ring& ring = state.Mesh.Rings[this->Stack[i]];
      for (int k = 0; k < ring.Count; ++k)
      {
        if (state.Component[ring.Item[k]] < 0)
        {
          state.Component[ring.Item[k]] = label;
          this->Stack.push_back(ring.Item[k]);
        }
      }
    }
    if (this->Stack.size() <= SmallSize)
    {
      this->Smalls.push_back({ this->Stack, SignedVolume(state.Mesh, this->Stack) > 0 });
    }
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
      if (state.Mesh.IsAlive(v))
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
    small.Vertices = this->Stack;
    for (int v : small.Vertices)
    {
      state.Component[v] = 0;
    }
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
      state.RemoveComponent(seed);
      deleted = true;
    }
  }
  if (deleted)
  {
    this->Label(state);
  }
  return deleted;
}
}
