// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceJudge.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace volumic::support
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

struct Soup
{
  std::vector<Kernel::Point_3> Points;
  std::vector<std::vector<std::size_t>> Triangles;
};

/** Return the triangles with three different corners and their points. */
Soup SoupOf(const TriangleSurface& surface, TopologyVerdict& verdict)
{
  Soup soup;
  for (const auto& p : surface.Points)
  {
    soup.Points.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto& t : surface.Triangles)
  {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
    {
      ++verdict.Faults;
      continue;
    }
    soup.Triangles.emplace_back(t.begin(), t.end());
  }
  verdict.UnusedPoints = PMP::remove_isolated_points_in_polygon_soup(soup.Points, soup.Triangles);
  return soup;
}

void JudgeEdges(const Soup& soup, TopologyVerdict& verdict)
{
  std::vector<std::array<std::size_t, 3>> sides; // both ends and the direction
  for (const auto& t : soup.Triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      const auto [low, high] = std::minmax(t[c], t[(c + 1) % 3]);
      sides.push_back({ low, high, t[c] == low });
    }
  }
  std::sort(sides.begin(), sides.end());
  bool hasOpen = false;
  for (auto side = sides.begin(); side != sides.end();)
  {
    const auto end = std::find_if(side, sides.end(),
      [side](const auto& s) { return s[0] != (*side)[0] || s[1] != (*side)[1]; });
    const auto count = end - side;
    const bool isMisoriented = count == 2 && side[0][2] == side[1][2];
    hasOpen = hasOpen || count == 1;
    verdict.Manifold = verdict.Manifold && count <= 2;
    verdict.Oriented = verdict.Oriented && !isMisoriented;
    verdict.Faults += count != 2 || isMisoriented;
    side = end;
  }
  verdict.Closed = !hasOpen;
}

void JudgeComponents(Mesh& mesh, TopologyVerdict& verdict)
{
  const auto component = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:component").first;
  verdict.Components.resize(PMP::connected_components(mesh, component));
  const Kernel::Point_3 origin = mesh.point(*mesh.vertices().begin());
  for (const auto face : mesh.faces())
  {
    const auto h = mesh.halfedge(face);
    const Kernel::Vector_3 a = mesh.point(mesh.source(h)) - origin;
    const Kernel::Vector_3 b = mesh.point(mesh.target(h)) - origin;
    const Kernel::Vector_3 c = mesh.point(mesh.target(mesh.next(h))) - origin;
    const double volume = a * CGAL::cross_product(b, c) / 6.0;
    verdict.Area += 0.5 * std::sqrt(CGAL::cross_product(b - a, c - a).squared_length());
    verdict.Components[component[face]] += volume;
    verdict.Volume += volume;
  }
  verdict.EulerCharacteristic = static_cast<int>(mesh.number_of_vertices()) +
    static_cast<int>(mesh.number_of_faces()) - static_cast<int>(mesh.number_of_edges());
}
} // namespace

TopologyVerdict JudgeTopology(const TriangleSurface& surface)
{
  TopologyVerdict verdict;
  Soup soup = SoupOf(surface, verdict);
  if (soup.Triangles.empty())
  {
    return verdict;
  }
  verdict.Manifold = verdict.Faults == 0;
  verdict.Oriented = true;
  JudgeEdges(soup, verdict);
  if (!PMP::is_polygon_soup_a_polygon_mesh(soup.Triangles))
  {
    const std::size_t before = soup.Points.size();
    PMP::orient_polygon_soup(soup.Points, soup.Triangles); // duplicates points where fans touch
    verdict.Faults += soup.Points.size() - before;
    verdict.Manifold = verdict.Manifold && soup.Points.size() == before;
  }
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.Points, soup.Triangles, mesh);
  JudgeComponents(mesh, verdict);
  if (verdict.Closed && verdict.Manifold && verdict.Oriented)
  {
    verdict.Genus = static_cast<int>(verdict.Components.size()) - verdict.EulerCharacteristic / 2;
    verdict.Outward = PMP::does_bound_a_volume(mesh) && PMP::is_outward_oriented(mesh);
  }
  return verdict;
}
} // namespace volumic::support
