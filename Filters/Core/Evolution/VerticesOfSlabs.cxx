// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/VerticesOfSlabs.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 16384;
/** Faces so near to a layer, in layers, are taken to cross it. */
constexpr double Margin = 0.01;

/** Slabs [Begin, End). */
struct SlabRange
{
  int Begin = 0;
  int End = 0;
};

/** Finds the slabs that a vertex matters in. */
class SlabFinder
{
public:
  SlabFinder(const SurfaceMesh& mesh, const LevelImage& image, int layersOfSlab, double reach)
    : Mesh(mesh), Inverse(1. / image.Step[2]), Last(image.Size[2] - 1), Layers(layersOfSlab),
      Reach(reach * Inverse)
  {
  }

  SlabRange SlabsOf(int v) const
  {
    const double place = this->Mesh.Position[v].Z * this->Inverse;
    double low = place - std::max(this->Reach, Margin);
    double high = place + std::max(this->Reach, Margin);
    const Ring& ring = this->Mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      if (!this->Mesh.IsAlive(ring.Item[i]))
      {
        continue; // At the rim of what is here of the surface.
      }
      const double other = this->Mesh.Position[ring.Item[i]].Z * this->Inverse;
      low = std::min(low, other - Margin);
      high = std::max(high, other + Margin);
    }
    if (high < 0. || low > this->Last)
    {
      return {};
    }
    const int first = std::max(0, static_cast<int>(std::ceil(low)));
    const int last = std::min(this->Last, static_cast<int>(std::floor(high)));
    return first <= last ? SlabRange{ first / this->Layers, last / this->Layers + 1 } : SlabRange();
  }

private:
  const SurfaceMesh& Mesh;
  double Inverse;
  int Last; ///< Layer of the image.
  int Layers;
  double Reach; ///< In layers.
};
}

VerticesOfSlabs::VerticesOfSlabs(const SurfaceMesh& mesh, const LevelImage& image,
  int layersOfSlab, double reach, Executor& executor)
{
  const SlabFinder finder(mesh, image, layersOfSlab, reach);
  const auto slabs = static_cast<std::size_t>((image.Size[2] + layersOfSlab - 1) / layersOfSlab);
  const std::size_t n = mesh.Rings.size();
  const std::size_t spans = (n + VertexSpan - 1) / VertexSpan;
  LargeVector<SlabRange> ranges;
  MakeZeroed(ranges, n); // Where there is no vertex it stays so.
  // Of each span and slab: first how many there are, then where the next one goes.
  std::vector<std::size_t> next(spans * slabs, 0);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (!mesh.IsAlive(static_cast<int>(v)))
        {
          continue;
        }
        ranges[v] = finder.SlabsOf(static_cast<int>(v));
        for (int slab = ranges[v].Begin; slab < ranges[v].End; ++slab)
        {
          ++next[span * slabs + slab];
        }
      }
    });
  this->First.resize(slabs + 1, 0);
  std::size_t sum = 0;
  for (std::size_t slab = 0; slab < slabs; ++slab)
  {
    for (std::size_t span = 0; span < spans; ++span)
    {
      const std::size_t count = next[span * slabs + slab];
      next[span * slabs + slab] = sum;
      sum += count;
    }
    this->First[slab + 1] = sum;
  }
  this->Vertices.resize(sum);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        for (int slab = ranges[v].Begin; slab < ranges[v].End; ++slab)
        {
          this->Vertices[next[span * slabs + slab]++] = static_cast<int>(v);
        }
      }
    });
}
}
