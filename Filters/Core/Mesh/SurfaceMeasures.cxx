// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMeasures.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 2048;
}

double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor)
{
  const Vector origin = mesh.Position.front();
  SignedVolume whole;
  whole.Eighteenfold = SumOfSpans(executor, mesh.Rings.size(), SpanSize,
    [&](std::size_t begin, std::size_t end)
    {
      SignedVolume volume(origin);
      for (std::size_t v = begin; v < end; ++v)
      {
        if (mesh.IsAlive(static_cast<int>(v)))
        {
          volume.Add(mesh, static_cast<int>(v));
        }
      }
      return volume.Eighteenfold;
    });
  return whole.Value();
}

Box BoundsOf(const SurfaceMesh& mesh, Executor& executor)
{
  constexpr float most = std::numeric_limits<float>::max();
  const Box none = { Vector(most, most, most), Vector(-most, -most, -most) };
  const Box box = JoinVertices(
    mesh, executor, none,
    [&mesh](int v, Box& some) {
      some = mesh.IsAlive(v) ? some.With({ mesh.Position[v], mesh.Position[v] }) : some;
    },
    [](const Box& a, const Box& b) { return a.With(b); });
  return mesh.NumberOfVertices() > 0 ? box : Box();
}

double VertexArea(const SurfaceMesh& mesh, int v)
{
  const Ring& ring = mesh.Rings[v];
  const Vector& p = mesh.Position[v];
  double sum = 0.;
  for (int i = 0; i < ring.Count; ++i)
  {
    sum += Length(Cross(mesh.Position[ring.Item[i]] - p, mesh.Position[ring.Next(i)] - p));
  }
  return sum / 6.;
}
}
