// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedVoxels.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Spans.h"
#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
/** Vertices per span of a parallel loop. */
constexpr std::size_t VertexSpan = 16384;
/** Faces within this distance of a layer, in layers, count as crossing. */
constexpr double Margin = 0.01;

/** Slabs [Begin, End). */
struct SlabRange
{
  int Begin = 0;
  int End = 0;
};

/** Find the slabs that a vertex affects. */
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
    const double position = this->Mesh.Position[v].Z * this->Inverse;
    double low = position - std::max(this->Reach, Margin);
    double high = position + std::max(this->Reach, Margin);
    const Ring& ring = this->Mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      if (!this->Mesh.IsAlive(ring.Item[i]))
      {
        continue; // At a boundary of the open mesh.
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
  int Last; ///< last layer of the image
  int Layers;
  double Reach; ///< in layers
};

/**
 * Vertices that affect each slab of layers: those within reach of a layer along z, and those with a
 * face that crosses a layer. A vertex may affect several slabs.
 */
class VerticesOfSlabs
{
public:
  /** @param reach in the computational space */
  VerticesOfSlabs(const SurfaceMesh& mesh, const LevelImage& image, int layersOfSlab, double reach,
    Executor& executor);

  /** Return the vertices of a slab. */
  const int* Begin(std::size_t slab) const { return this->Vertices.data() + this->First[slab]; }
  std::size_t Count(std::size_t slab) const { return this->First[slab + 1] - this->First[slab]; }

private:
  std::vector<std::size_t> First; ///< of each slab, and the end of the last one
  LargeVector<int> Vertices;
};

VerticesOfSlabs::VerticesOfSlabs(const SurfaceMesh& mesh, const LevelImage& image, int layersOfSlab,
  double reach, Executor& executor)
{
  const SlabFinder finder(mesh, image, layersOfSlab, reach);
  const auto slabs = static_cast<std::size_t>((image.Size[2] + layersOfSlab - 1) / layersOfSlab);
  const std::size_t n = mesh.Rings.size();
  const std::size_t spans = (n + VertexSpan - 1) / VertexSpan;
  LargeVector<SlabRange> ranges;
  MakeZeroed(ranges, n); // Unused slots stay zero.
  // By span and slab: first the number of vertices, then the position of the next one.
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

/** Layers per slab. */
constexpr int LayersOfSlab = 8;
/** Slabs between two calls of the progress callback. */
constexpr std::size_t SlabsPerBatch = 32;

/** Return whether a run is adjacent to another slab. */
bool IsAtBorder(const VoxelRun& run, const std::array<int, 3>& size)
{
  const int k = VoxelNumbers(size).IjkOf(run.First)[2];
  return (k % LayersOfSlab == 0 && k > 0) ||
    (k % LayersOfSlab == LayersOfSlab - 1 && k + 1 < size[2]);
}

/** Join adjacent runs of a sorted list. */
void JoinRuns(
  const std::vector<VoxelRun>& runs, const std::array<int, 3>& size, DisjointSets& joined)
{
  const VoxelNumbers numbers(size);
  for (const int axis : { 1, 2 })
  {
    const std::int64_t shift = numbers.Stride(axis);
    for (std::size_t i = 0, j = 0; j < runs.size();)
    {
      const std::int64_t first = runs[i].First + shift;
      const std::int64_t end = first + runs[i].Length;
      const std::int64_t otherEnd = runs[j].First + runs[j].Length;
      // The last row of a layer is followed by the first row of the next one.
      if (first < otherEnd && runs[j].First < end &&
        (axis == 2 || numbers.IjkOf(runs[i].First)[1] + 1 < size[1]))
      {
        joined.Join(static_cast<int>(i), static_cast<int>(j));
      }
      (end < otherEnd ? i : j) += 1;
    }
  }
}

/**
 * Number the parts of sorted runs by their first voxels, and remove those that are too small.
 * @param isOpen returns whether the part of a run may continue elsewhere @return number of parts
 */
template <typename IsOpen>
int NumberParts(std::vector<VoxelRun>& runs, const std::array<int, 3>& size,
  std::int64_t minimumSize, const IsOpen& isOpen)
{
  DisjointSets joined(runs.size());
  JoinRuns(runs, size, joined);
  std::vector<std::int64_t> voxels(runs.size(), 0); // by root, the first run of its part
  std::vector<char> stays(runs.size(), 0);          // by root
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    voxels[root] += runs[i].Length;
    stays[root] |= isOpen(runs[i]) || voxels[root] >= minimumSize;
  }
  int parts = 0;
  std::vector<int> number(runs.size(), 0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const auto root = static_cast<std::size_t>(joined.Find(static_cast<int>(i)));
    if (stays[root])
    {
      number[i] = root == i ? parts++ : number[root];
      runs[kept++] = { runs[i].First, runs[i].Length, number[i] };
    }
  }
  runs.resize(kept);
  runs.shrink_to_fit();
  return parts;
}
}

MissedVoxels FindMissedVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressCallback& goOn)
{
  const std::array<int, 3>& size = field.Image().Size;
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  const auto slabs = static_cast<std::size_t>((size[2] + LayersOfSlab - 1) / LayersOfSlab);
  std::vector<std::vector<VoxelRun>> runs(slabs);
  MissedVoxels missed;
  for (std::size_t first = 0; first < slabs && !missed.IsStopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForSpans(executor, count, 1,
      [&](std::size_t n, std::size_t, std::size_t)
      {
        const std::size_t slab = first + n;
        const int begin = static_cast<int>(slab) * LayersOfSlab;
        SlabSearch search(state, field, kind, begin, std::min(begin + LayersOfSlab, size[2]));
        search.LeaveSide(vertices.Begin(slab), vertices.Count(slab));
        for (std::size_t i = 0; i < vertices.Count(slab); ++i)
        {
          search.CloseNear(vertices.Begin(slab)[i]);
        }
        runs[slab] = search.FindRuns();
        NumberParts(runs[slab], size, minimumSize,
          [&size](const VoxelRun& run) { return IsAtBorder(run, size); });
      });
    missed.IsStopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  if (!missed.IsStopped)
  {
    missed.Runs = Joined(executor, runs);
    missed.Parts =
      NumberParts(missed.Runs, size, minimumSize, [](const VoxelRun&) { return false; });
  }
  return missed;
}
}
