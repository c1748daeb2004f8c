// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMeasures.h"

#include <cstddef>

namespace volumic
{
namespace
{
/** Vertices that one thread sums up at a time. */
constexpr std::size_t BlockSize = 2048;
}

double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor)
{
  const Vector origin = mesh.Position.front();
  SignedVolume whole;
  whole.Eighteenfold = SumOfBlocks(executor, mesh.Rings.size(), BlockSize,
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

double SurfaceArea(const SurfaceMesh& mesh, Executor& executor)
{
  const double sum = SumOfBlocks(executor, mesh.Rings.size(), BlockSize,
    [&](std::size_t begin, std::size_t end)
    {
      double block = 0.;
      for (std::size_t v = begin; v < end; ++v)
      {
        const Ring& ring = mesh.Rings[v];
        const Vector& p = mesh.Position[v];
        for (int i = 0; i < ring.Count; ++i)
        {
          block += Length(Cross(mesh.Position[ring.Item[i]] - p, mesh.Position[ring.Next(i)] - p));
        }
      }
      return block;
    });
  // Twice the area of each face, which is seen from its three corners.
  return sum / 6.;
}
}
