// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LegalEdges.h"

#include "Core/Mesh/EdgeCollapse.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
namespace
{
/** Cosine of the largest angle by which a collapse may turn a face: 45 degrees. */
constexpr float LeastCosine = 0.7f;
/** Least area of a face after a collapse, in squares of the shortest edge. */
constexpr float LeastArea = 0.074f;
/** Maximum sum of the valences of the ends of a collapsed edge. */
constexpr int MostNeighbours = 13;

void SplitLong(SurfaceMesh& mesh, float longest)
{
  for (int v = 0; v < mesh.Size(); ++v) // New vertices included, as halves may be too long.
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i)
    {
      const int w = mesh.Rings[v].Item[i];
      const EdgeSplit split = { v, w };
      if (SquaredDistance(mesh.Position[v], mesh.Position[w]) > longest * longest &&
        split.IsLegal(mesh))
      {
        split.Apply(mesh, (mesh.Position[v] + mesh.Position[w]) * 0.5f);
        i = -1;
      }
    }
  }
}

/** Return whether the faces of `end` without `other` stay valid if `end` moves. */
bool KeepFaces(const SurfaceMesh& mesh, int end, int other, const Vector& position, float leastArea,
  float longest)
{
  const Ring& ring = mesh.Rings[end];
  const Vector from = mesh.Position[end];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int b = ring.Item[i];
    const int c = ring.Next(i);
    if (b == other || c == other)
    {
      continue;
    }
    const Vector p = mesh.Position[b];
    const Vector q = mesh.Position[c];
    const Vector before = Cross(p - from, q - from);
    const Vector after = Cross(p - position, q - position);
    const float size = Length(after);
    if (SquaredDistance(position, p) > longest * longest || size < 2.f * leastArea ||
      Dot(before, after) < LeastCosine * Length(before) * size)
    {
      return false;
    }
  }
  return true;
}

void CollapseShort(SurfaceMesh& mesh, float bound, float leastArea, float longest)
{
  for (int v = 0; v < mesh.Size(); ++v)
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i)
    {
      const int w = mesh.Rings[v].Item[i];
      const EdgeCollapse collapse = { v, w };
      const Vector middle = (mesh.Position[v] + mesh.Position[w]) * 0.5f;
      if (SquaredDistance(mesh.Position[v], mesh.Position[w]) < bound * bound &&
        mesh.Rings[v].Count + mesh.Rings[w].Count <= MostNeighbours && collapse.IsLegal(mesh) &&
        KeepFaces(mesh, v, w, middle, leastArea, longest) &&
        KeepFaces(mesh, w, v, middle, leastArea, longest))
      {
        collapse.Apply(mesh);
        mesh.Position[v] = middle;
        i = -1;
      }
    }
  }
}
}

IndexedSurface WithLegalEdges(
  const IndexedSurface& surface, float shortest, float longest, Executor& executor)
{
  SurfaceMesh mesh;
  mesh.Append(surface, executor);
  SplitLong(mesh, longest);
  const float leastArea = LeastArea * shortest * shortest;
  for (const float factor : { 0.7f, 1.f }) // Shortest edges first.
  {
    CollapseShort(mesh, factor * shortest, leastArea, longest);
  }
  return mesh.ToIndexed(executor);
}
}
