// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarScore.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
float FaceScore(const Vector& a, const Vector& b, const Vector& c)
{
  const float x = std::sqrt(SquaredDistance(a, b));
  const float y = std::sqrt(SquaredDistance(b, c));
  const float z = std::sqrt(SquaredDistance(c, a));
  const float product = x * y * z;
  return product > 0 ? (y + z - x) * (z + x - y) * (x + y - z) / product : -1.f;
}

float EdgeScore(const SizingField& sizing, int u, int v, float squared)
{
  const float length = sizing.InDelta(u, v, std::sqrt(squared));
  if (length < 1 + ScoreMargin)
  {
    return length - 1 - ScoreMargin;
  }
  const float over = length / (SizingField::LongestEdgeInDelta * (1 - ScoreMargin)) - 1;
  return over > 0 ? -over : 1.f;
}

float StarScore(const SurfaceState& state, int v, const Vector& position, float bound)
{
  const SurfaceMesh& mesh = state.Mesh;
  const Ring& ring = mesh.Rings[v];
  float worst = 1;
  for (int i = 0; i < ring.Count && worst > bound; ++i)
  {
    const int w = ring.Item[i];
    const Vector& a = mesh.Position[w];
    worst = std::min(worst, EdgeScore(state.Sizing, v, w, SquaredDistance(position, a)));
    worst = std::min(worst, FaceScore(position, a, mesh.Position[ring.Next(i)]));
  }
  return worst;
}

float CollapseScore(const SurfaceState& state, int u, int v, const Vector& position, float bound)
{
  const SurfaceMesh& mesh = state.Mesh;
  float worst = 1;
  for (int end : { u, v })
  {
    const int other = end == u ? v : u;
    const Ring& ring = mesh.Rings[end];
    for (int i = 0; i < ring.Count && worst > bound; ++i)
    {
      const int b = ring.Item[i];
      const int c = ring.Next(i);
      if (b == other)
      {
        continue;
      }
      const Vector& neighbour = mesh.Position[b];
      worst = std::min(worst, EdgeScore(state.Sizing, u, b, SquaredDistance(position, neighbour)));
      if (c != other)
      {
        worst = std::min(worst, FaceScore(position, neighbour, mesh.Position[c]));
      }
    }
  }
  return worst;
}
}
