// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCoreTestTools_h
#define volumicCoreTestTools_h

#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/LevelImage.h"
#include "Core/Mesh/SurfaceCheck.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "ForVoxels.h"
#include "MeshInvariants.h"

namespace volumic
{
/** Voxels and their image. The volume must outlive the image. */
struct TestVolume
{
  std::vector<float> Values;
  LevelImage Image;
};

/** Return a volume of n x n x n voxels with the values f(x, y, z). */
inline TestVolume MakeVolume(int n, const std::function<double(double, double, double)>& f)
{
  TestVolume volume;
  volume.Values.reserve(static_cast<std::size_t>(n) * n * n);
  ForVoxels({ n, n, n },
    [&](int i, int j, int k) { volume.Values.push_back(static_cast<float>(f(i, j, k))); });
  volume.Image.Values = volume.Values.data();
  volume.Image.Size = { n, n, n };
  return volume;
}

inline SurfaceOptions WithIso(double iso)
{
  SurfaceOptions options;
  options.IsoValue = iso;
  return options;
}

/** Return 1 inside, 0 outside, with a ramp of two voxels; iso-value .5. */
inline double Soft(double signedDistance)
{
  return std::min(1., std::max(0., 0.5 - 0.5 * signedDistance));
}

inline double Distance(double x, double y, double z, double a, double b, double c)
{
  return std::sqrt((x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c));
}

inline SurfaceMesh MeshOf(const IndexedSurface& surface)
{
  SurfaceMesh mesh;
  mesh.Append(surface);
  return mesh;
}

/** Expect a valid mesh without self-intersections. */
inline void ExpectValidMesh(const IndexedSurface& surface)
{
  EXPECT_EQ(DescribeBrokenInvariant(MeshOf(surface)), "");
  EXPECT_EQ(CountSelfIntersections(surface), 0);
}

/** Call visit(u, v, length) for each edge, twice. */
template <typename Visit>
void VisitEdges(const IndexedSurface& surface, const Visit& visit)
{
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point& a = surface.Points[t[k]];
      const Point& b = surface.Points[t[(k + 1) % 3]];
      visit(t[k], t[(k + 1) % 3], Distance(a[0], a[1], a[2], b[0], b[1], b[2]));
    }
  }
}

inline void ExpectEdgesWithin(const IndexedSurface& surface, double shortest, double longest)
{
  double least = HUGE_VAL, most = 0;
  VisitEdges(surface,
    [&](int, int, double length)
    {
      least = std::min(least, length);
      most = std::max(most, length);
    });
  EXPECT_GE(least, shortest);
  EXPECT_LE(most, longest);
}

inline SurfaceMesh MakeSphere(const Point& centre, double radius, double meanEdge)
{
  return MeshOf(DividedIcosahedron(centre, radius, meanEdge));
}

/** Append a surface to another one. */
inline void AddSurface(IndexedSurface& to, const IndexedSurface& more)
{
  const int first = static_cast<int>(to.Points.size());
  to.Points.insert(to.Points.end(), more.Points.begin(), more.Points.end());
  for (const Triangle& t : more.Triangles)
  {
    to.Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  }
}

inline IndexedSurface InsideOut(IndexedSurface surface)
{
  for (Triangle& t : surface.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  return surface;
}

/** Octahedron with semi-axes x, y, z. Vertices in the order +x, -x, +y, -y, +z, -z. */
inline IndexedSurface Octahedron(const Point& centre, double x, double y, double z)
{
  const auto& [a, b, c] = centre;
  return { { { a + x, b, c }, { a - x, b, c }, { a, b + y, c }, { a, b - y, c }, { a, b, c + z },
             { a, b, c - z } },
    { { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 }, { 2, 0, 5 }, { 1, 2, 5 }, { 3, 1, 5 },
      { 0, 3, 5 } } };
}

/** Octahedron with equal edges. */
inline IndexedSurface EvenOctahedron(const Point& centre, double edge)
{
  const double r = edge / std::sqrt(2.);
  return Octahedron(centre, r, r, r);
}

inline IndexedSurface Cuboid(const Point& low, const Point& high)
{
  IndexedSurface box;
  for (int i = 0; i < 8; ++i)
  {
    box.Points.push_back(
      { i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2] });
  }
  for (const auto& q : { std::array<int, 4>{ 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 },
         { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    box.Triangles.push_back({ q[0], q[1], q[2] });
    box.Triangles.push_back({ q[2], q[3], q[0] });
  }
  return box;
}

/** Double cone along z. Vertices 0 and 1 are the tips, the others follow in order. */
inline IndexedSurface DoubleCone(int sides)
{
  IndexedSurface cone;
  cone.Points = { { 0, 0, 5 }, { 0, 0, -5 } };
  for (int i = 0; i < sides; ++i)
  {
    const double a = 2 * 3.14159265358979 * i / sides;
    const int next = 2 + (i + 1) % sides;
    cone.Points.push_back({ 5 * std::cos(a), 5 * std::sin(a), 0 });
    cone.Triangles.push_back({ 0, 2 + i, next });
    cone.Triangles.push_back({ 1, next, 2 + i });
  }
  return cone;
}

/** Torus around the z axis with n x m vertices. */
inline IndexedSurface MakeTorus(const Point& centre, double major, double minor, int n, int m)
{
  IndexedSurface surface;
  const double turn = 2. * 3.14159265358979;
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      const double a = turn * i / n;
      const double b = turn * j / m;
      const double r = major + minor * std::cos(b);
      surface.Points.push_back({ centre[0] + r * std::cos(a), centre[1] + r * std::sin(a),
        centre[2] + minor * std::sin(b) });
    }
  }
  const auto at = [n, m](int i, int j) { return (i % n) * m + j % m; };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      surface.Triangles.push_back({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
      surface.Triangles.push_back({ at(i, j), at(i + 1, j + 1), at(i, j + 1) });
    }
  }
  return surface;
}
}

#endif
