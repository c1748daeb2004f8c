// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceJudge.h"

#include "JudgeInternals.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace volumic::support
{

void CheckSurface(const TriangleSurface& surface)
{
  const int count = static_cast<int>(surface.Points.size());
  for (const auto& p : surface.Points)
  {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
    {
      throw std::invalid_argument("SurfaceJudge: a coordinate is not finite");
    }
  }
  for (const auto& t : surface.Triangles)
  {
    for (const int v : t)
    {
      if (v < 0 || v >= count)
      {
        throw std::invalid_argument("SurfaceJudge: a triangle refers to point " +
          std::to_string(v) + " of " + std::to_string(count));
      }
    }
  }
}

std::vector<std::pair<int, int>> UniqueEdges(const TriangleSurface& surface)
{
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * surface.Triangles.size());
  for (const auto& t : surface.Triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      edges.emplace_back(std::minmax(t[c], t[(c + 1) % 3]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

double Quantile(std::vector<double>& values, double fraction)
{
  if (values.empty())
  {
    return 0.0;
  }
  const std::size_t rank =
    std::min(values.size() - 1, static_cast<std::size_t>(fraction * values.size()));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[rank];
}

SurfaceVerdict JudgeSurface(
  const TriangleSurface& surface, double delta, const JudgedVolume* volume)
{
  SurfaceVerdict verdict;
  verdict.Topology = JudgeTopology(surface);
  verdict.Intersections = JudgeIntersections(surface);
  verdict.Lengths = JudgeLengths(surface, delta);
  verdict.Shapes = JudgeShapes(surface);
  verdict.HasVolume = volume != nullptr;
  if (volume)
  {
    verdict.IsoDistance = JudgeIsoDistance(surface, *volume);
    verdict.Reach = JudgeReach(surface, *volume);
  }
  return verdict;
}

std::string Describe(const SurfaceVerdict& verdict)
{
  const TopologyVerdict& topology = verdict.Topology;
  std::ostringstream text;
  text.precision(4);
  text << topology.Components.size() << " components, chi " << topology.EulerCharacteristic
       << ", genus " << topology.Genus << ", area " << topology.Area << ", volume "
       << topology.Volume << "\n"
       << (topology.Closed ? "closed" : "NOT CLOSED") << ", "
       << (topology.Manifold ? "manifold" : "NOT MANIFOLD") << ", "
       << (topology.Oriented ? "oriented" : "NOT ORIENTED") << ", "
       << (topology.Outward ? "outward" : "NOT OUTWARD") << " (" << topology.Faults << " faults)\n"
       << "self-intersecting pairs " << verdict.Intersections.Pairs << ", flat triangles "
       << verdict.Intersections.FlatTriangles << "\n"
       << "edges " << verdict.Lengths.Shortest << " / " << verdict.Lengths.Mean << " / "
       << verdict.Lengths.Longest << ", too short " << verdict.Lengths.EdgesTooShort
       << ", too long " << verdict.Lengths.EdgesTooLong << ", pairs too near "
       << verdict.Lengths.NearPairs << "\n"
       << "radius ratio least " << verdict.Shapes.Least << ", 1 % quantile "
       << verdict.Shapes.Quantile01 << ", mean " << verdict.Shapes.Mean << "\n";
  if (verdict.HasVolume)
  {
    text << "distance to the isosurface, voxels: at vertices mean "
         << verdict.IsoDistance.MeanAtVertices << ", 99 % "
         << verdict.IsoDistance.Quantile99AtVertices << ", largest "
         << verdict.IsoDistance.LargestAtVertices << "; at centroids mean "
         << verdict.IsoDistance.MeanAtCentroids << "\n"
         << "reached " << verdict.Reach.FoundVoxels << " of " << verdict.Reach.ReachableVoxels
         << " reachable boundary voxels (" << 100.0 * verdict.Reach.Share << " %)\n";
  }
  return text.str();
}

} // namespace volumic::support
