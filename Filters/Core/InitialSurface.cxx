// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "InitialSurface.h"

#include "Division.h"
#include "Join.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace volumic
{
IndexedSurface Icosahedron(const Point& centre, double radius)
{
  const double golden = 0.5 * (1. + std::sqrt(5.));
  const double scale = radius / std::sqrt(1. + golden * golden);
  const double s = scale;
  const double l = scale * golden;
  IndexedSurface surface;
  for (const Point& p : { Point{ -s, l, 0 }, Point{ s, l, 0 }, Point{ -s, -l, 0 },
         Point{ s, -l, 0 }, Point{ 0, -s, l }, Point{ 0, s, l }, Point{ 0, -s, -l },
         Point{ 0, s, -l }, Point{ l, 0, -s }, Point{ l, 0, s }, Point{ -l, 0, -s },
         Point{ -l, 0, s } })
  {
    surface.Points.push_back({ p[0] + centre[0], p[1] + centre[1], p[2] + centre[2] });
  }
  surface.Triangles = { { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 }, { 0, 10, 11 },
    { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 },
    { 3, 4, 2 }, { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 },
    { 6, 2, 10 }, { 8, 6, 7 }, { 9, 8, 1 } };
  return surface;
}

namespace
{
/** On the unit sphere about the origin. */
SurfaceMesh DividedSphere(double meanEdge)
{
  SurfaceMesh mesh;
  mesh.Append(Icosahedron({ 0., 0., 0. }, 1.));
  double edge = 1.0515;
  constexpr int most = 16;
  for (int i = 0; i < most && edge > meanEdge; ++i)
  {
    Divide(mesh);
    for (Vector& p : mesh.Position)
    {
      p = Normalized(p);
    }
    edge /= std::sqrt(3.);
  }
  return mesh;
}
}

IndexedSurface DividedIcosahedron(const Point& centre, double radius, double meanEdge)
{
  IndexedSurface surface = DividedSphere(meanEdge / radius).ToIndexed();
  for (Point& p : surface.Points)
  {
    for (int k = 0; k < 3; ++k)
    {
      p[k] = centre[k] + radius * p[k];
    }
  }
  return surface;
}

IndexedSurface EnclosingSurface(const LevelImage& image, double meanEdge)
{
  Point centre;
  Point axis;
  double largest = 0.;
  for (int k = 0; k < 3; ++k)
  {
    // Voxels lie at 0 .. (Size - 1) Step; the field falls to the background one Step beyond.
    centre[k] = 0.5 * (image.Size[k] - 1) * image.Step[k];
    axis[k] = std::pow(3., 0.25) * (centre[k] + image.Step[k]);
    largest = std::max(largest, axis[k]);
  }
  IndexedSurface surface = DividedSphere(meanEdge / largest).ToIndexed();
  for (Point& p : surface.Points)
  {
    double sum = 0.;
    for (int k = 0; k < 3; ++k)
    {
      sum += p[k] * p[k] * p[k] * p[k];
    }
    const double scale = std::pow(sum, -0.25);
    for (int k = 0; k < 3; ++k)
    {
      p[k] = centre[k] + axis[k] * scale * p[k];
    }
  }
  return surface;
}

IndexedSurface LimitValence(const IndexedSurface& surface)
{
  constexpr int most = 12;
  IndexedSurface result;
  std::vector<int> place(surface.Points.size(), -1);
  for (Triangle t : surface.Triangles)
  {
    for (int& corner : t)
    {
      if (place[corner] < 0)
      {
        place[corner] = static_cast<int>(result.Points.size());
        result.Points.push_back(surface.Points[corner]);
      }
      corner = place[corner];
    }
    result.Triangles.push_back(t);
  }
  const int olds = static_cast<int>(result.Points.size());
  std::vector<std::vector<int>> trianglesOf(olds);
  for (std::size_t i = 0; i < result.Triangles.size(); ++i)
  {
    for (int corner : result.Triangles[i])
    {
      trianglesOf[corner].push_back(static_cast<int>(i));
    }
  }
  for (int v = 0; v < olds; ++v)
  {
    if (static_cast<int>(trianglesOf[v].size()) <= most)
    {
      continue;
    }
    // Another crowded point may have changed these triangles: gather them afresh.
    std::vector<int> fan;
    std::vector<std::pair<int, int>> edges;
    for (std::size_t i = 0; i < result.Triangles.size(); ++i)
    {
      const Triangle& t = result.Triangles[i];
      for (int k = 0; k < 3; ++k)
      {
        if (t[k] == v)
        {
          fan.push_back(static_cast<int>(i));
          edges.emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
        }
      }
    }
    std::vector<int> ring(1, edges.front().first);
    while (ring.size() < edges.size())
    {
      for (const auto& edge : edges)
      {
        if (edge.first == ring.back())
        {
          ring.push_back(edge.second);
          break;
        }
      }
    }
    std::vector<Triangle> added;
    while (static_cast<int>(ring.size()) > most)
    {
      // Point j of the inner ring lies half way to point 2 j of the outer one.
      const std::size_t n = ring.size();
      std::vector<int> inner;
      for (std::size_t i = 0; i < n; i += 2)
      {
        Point middle;
        for (int k = 0; k < 3; ++k)
        {
          middle[k] = 0.5 * (result.Points[v][k] + result.Points[ring[i]][k]);
        }
        inner.push_back(static_cast<int>(result.Points.size()));
        result.Points.push_back(middle);
      }
      for (std::size_t i = 0; i < n; ++i)
      {
        const int next = ring[(i + 1) % n];
        added.push_back({ inner[i / 2], ring[i], next });
        if (i % 2 == 1 || i + 1 == n)
        {
          added.push_back({ inner[i / 2], next, inner[(i / 2 + 1) % inner.size()] });
        }
      }
      ring.swap(inner);
    }
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      added.push_back({ v, ring[i], ring[(i + 1) % ring.size()] });
    }
    for (std::size_t i = 0; i < added.size(); ++i)
    {
      if (i < fan.size())
      {
        result.Triangles[fan[i]] = added[i];
      }
      else
      {
        result.Triangles.push_back(added[i]);
      }
    }
  }
  return result;
}

namespace
{
bool IsInside(const Field& field, const Point& p)
{
  return field.ValueAt(Vector(static_cast<float>(p[0]), static_cast<float>(p[1]),
           static_cast<float>(p[2]))) > 0;
}
}

std::vector<Point> ChooseSeeds(
  const Field& field, const std::vector<Point>& centres, double spacing)
{
  const LevelImage& image = field.Image();
  std::vector<Point> chosen;
  for (std::size_t i = 0; i < centres.size(); ++i)
  {
    const Point& p = centres[i];
    for (int k = 0; k < 3; ++k)
    {
      if (!(p[k] >= 0. && p[k] <= image.Size[k] * image.Step[k]))
      {
        throw std::invalid_argument(Join("Seed ", i, " lies outside the image: ", p[k],
          " voxels along axis ", k, ", the image has ", image.Size[k] * image.Step[k], "."));
      }
    }
    bool free = IsInside(field, p);
    for (const Point& q : chosen)
    {
      const double x = p[0] - q[0];
      const double y = p[1] - q[1];
      const double z = p[2] - q[2];
      free = free && x * x + y * y + z * z >= spacing * spacing;
    }
    if (free)
    {
      chosen.push_back(p);
    }
  }
  if (centres.empty())
  {
    int count[3];
    double first[3];
    for (int k = 0; k < 3; ++k)
    {
      const double extent = (image.Size[k] - 1) * image.Step[k];
      count[k] = static_cast<int>(extent / spacing) + 1;
      first[k] = 0.5 * (extent - (count[k] - 1) * spacing);
    }
    for (int z = 0; z < count[2]; ++z)
    {
      for (int y = 0; y < count[1]; ++y)
      {
        for (int x = 0; x < count[0]; ++x)
        {
          const Point p = { first[0] + x * spacing, first[1] + y * spacing,
            first[2] + z * spacing };
          if (IsInside(field, p))
          {
            chosen.push_back(p);
          }
        }
      }
    }
  }
  if (chosen.empty())
  {
    throw std::invalid_argument(centres.empty()
        ? "No point of the grid of seeds lies inside the object. Give a smaller SeedRadius or "
          "another IsoValue."
        : "None of the " + std::to_string(centres.size()) +
          " seeds lies inside the object. Move them, or check IsoValue and ObjectIsBright.");
  }
  return chosen;
}
}
