// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/RankMeasures.h"

#include "Core/Mesh/SurfaceMeasures.h"

#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexBlock = 4096;

/** visit(sum, v) for the own vertices, each block with a sum of its own; these are added up. */
template <typename Sum, typename Visit>
Sum SumOfOwn(
  const RankPart& part, const SurfaceMesh& mesh, Executor& executor, const Visit& visit)
{
  std::vector<Sum> sums((mesh.Rings.size() + VertexBlock - 1) / VertexBlock);
  ForBlocks(executor, mesh.Rings.size(), VertexBlock,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (mesh.IsAlive(v) && part.IsOwn(v))
        {
          visit(sums[b], v);
        }
      }
    });
  Sum all;
  for (const Sum& ofBlock : sums)
  {
    all.Add(ofBlock);
  }
  return all;
}

struct Counts
{
  std::int64_t Vertices = 0;
  std::int64_t Neighbours = 0;
  void Add(const Counts& other)
  {
    this->Vertices += other.Vertices;
    this->Neighbours += other.Neighbours;
  }
};
}

double SumOverRanks(Communicator& ranks, const ExactSum& sum)
{
  ExactSum all;
  for (const ExactSum& ofRank : GatherValues(ranks, sum))
  {
    all.Add(ofRank);
  }
  return all.Value();
}

double SumOverRanks(const RankPart& part, const SurfaceMesh& mesh, Executor& executor,
  const std::function<double(int v)>& termOf)
{
  return SumOverRanks(part.Ranks,
    SumOfOwn<ExactSum>(
      part, mesh, executor, [&termOf](ExactSum& sum, int v) { sum.Add(termOf(v)); }));
}

SurfaceCounts CountOverRanks(const RankPart& part, const SurfaceMesh& mesh, Executor& executor)
{
  const Counts own = SumOfOwn<Counts>(part, mesh, executor,
    [&mesh](Counts& sum, int v) { sum.Add({ 1, mesh.Rings[v].Count }); });
  Counts all;
  for (const Counts& ofRank : GatherValues(part.Ranks, own))
  {
    all.Add(ofRank);
  }
  return { all.Vertices, all.Neighbours / 2 };
}

double EnclosedVolume(const RankPart& part, const SurfaceMesh& mesh, Executor& executor)
{
  // The workspace's origin is the same everywhere, and no farther than the image is wide.
  const double sum = SumOverRanks(part, mesh, executor,
    [&mesh](int v) { return SignedVolume::OfVertex(mesh, VectorD(), v); });
  return sum / 18.;
}

double SurfaceArea(const RankPart& part, const SurfaceMesh& mesh, Executor& executor)
{
  const double sum = SumOverRanks(part, mesh, executor,
    [&mesh](int v)
    {
      double aboutVertex = 0.;
      const Ring& ring = mesh.Rings[v];
      const Vector& p = mesh.Position[v];
      for (int i = 0; i < ring.Count; ++i)
      {
        aboutVertex +=
          Length(Cross(mesh.Position[ring.Item[i]] - p, mesh.Position[ring.Next(i)] - p));
      }
      return aboutVertex;
    });
  // Twice the area of each face, which is seen from its three corners.
  return sum / 6.;
}

double MeanEdgeLength(const RankPart& part, const SurfaceState& state, Executor& executor)
{
  const double sum = SumOverRanks(part, state.Mesh, executor,
    [&state](int v) { return static_cast<double>(state.EdgeLengthSum[v]); });
  // Each edge is in two sums.
  const std::int64_t edges = CountOverRanks(part, state.Mesh, executor).Edges;
  return edges > 0 ? sum / (2. * static_cast<double>(edges)) : 0.;
}
}
