// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceJudge.h"

#include "JudgeInternals.h"

#include <algorithm>
#include <sstream>

namespace volumic::support
{

std::vector<std::pair<int, int>> UniqueEdges(const TriangleSurface& surface)
{
  std::vector<std::pair<int, int>> edges;
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

SurfaceVerdict JudgeSurface(const TriangleSurface& surface, double delta)
{
  return { JudgeTopology(surface), JudgeIntersections(surface), JudgeLengths(surface, delta),
    JudgeShapes(surface) };
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
  return text.str();
}

} // namespace volumic::support
