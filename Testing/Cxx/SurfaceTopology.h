// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceTopology_h
#define volumicSurfaceTopology_h

#include "Core/Common/DisjointSets.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "TestPrelude.h"

#include <tuple>

namespace volumic
{
/** Topology of the surface of an object of an interface mesh. */
struct SurfaceTopology
{
  int BadLinks = 0;   ///< vertices whose link is not one cycle: 0 if closed, oriented and manifold
  int BadVertex = -1; ///< one of these
  int Vertices = 0, Faces = 0;
  int Positive = 0; ///< components of positive signed volume
  int Negative = 0;
  double Volume = 0.;

  /** Of the block, if the surface is closed: half of that of the surface. */
  double Euler() const { return 0.5 * (this->Vertices - 0.5 * this->Faces); }
};

/** All triangles, as they are. */
inline IndexedSurface AllFaces(const InterfaceMesh& mesh)
{
  IndexedSurface all;
  for (const Vector& p : mesh.Position)
  {
    all.Points.push_back({ p.X, p.Y, p.Z });
  }
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    if (face.IsThere())
    {
      all.Triangles.push_back(face.Vertex);
    }
  }
  return all;
}

/** Of all objects that have faces, but not of sides. */
inline std::map<int, SurfaceTopology> SurfacesOf(const InterfaceMesh& mesh)
{
  struct Corner
  {
    int Object;
    int From; ///< of an edge of the link
    int To;
    int Side; ///< of a face: twice its number, + 1 in front of it
  };
  std::map<int, SurfaceTopology> surfaces;
  DisjointSets parts(2 * mesh.Faces.size());
  std::vector<Corner> corners; // of a vertex
  const int numberOfVertices = static_cast<int>(mesh.Position.size());
  for (int v = 0; v < numberOfVertices; ++v)
  {
    corners.clear();
    mesh.ForFaces(v,
      [&](int f)
      {
        const InterfaceMesh::Face& face = mesh.Faces[static_cast<std::size_t>(f)];
        const int k = face.Vertex[0] == v ? 0 : face.Vertex[1] == v ? 1 : 2;
        const int next = face.Vertex[(k + 1) % 3];
        const int last = face.Vertex[(k + 2) % 3];
        corners.push_back({ face.Behind, next, last, 2 * f });
        corners.push_back({ face.Front, last, next, 2 * f + 1 });
      });
    const auto isBefore = [](const Corner& a, const Corner& b)
    { return std::tie(a.Object, a.From) < std::tie(b.Object, b.From); };
    std::sort(corners.begin(), corners.end(), isBefore);
    for (auto first = corners.begin(); first != corners.end();)
    {
      const auto end = std::find_if(
        first, corners.end(), [&](const Corner& c) { return c.Object != first->Object; });
      const auto after = [&](const Corner& c)
      {
        const auto next = std::lower_bound(first, end, Corner{ c.Object, c.To, 0, 0 }, isBefore);
        return next != end && next->From == c.To ? next : end;
      };
      // Around the link: it is one cycle if that ends where it began, after all corners.
      auto at = first;
      std::ptrdiff_t length = 0;
      do
      {
        const auto next = after(*at);
        parts.Join(at->Side, next == end ? at->Side : next->Side);
        at = next;
        ++length;
      } while (at != end && at != first && length < end - first);
      SurfaceTopology& surface = surfaces[first->Object];
      ++surface.Vertices;
      if (at != first || length != end - first)
      {
        ++surface.BadLinks;
        surface.BadVertex = v;
      }
      first = end;
    }
  }
  std::map<std::pair<int, int>, double> volumes; // of objects and components
  for (std::size_t f = 0; f < mesh.Faces.size(); ++f)
  {
    const InterfaceMesh::Face& face = mesh.Faces[f];
    if (!face.IsThere())
    {
      continue;
    }
    const auto at = [&](int k)
    { return VectorD(mesh.Position[static_cast<std::size_t>(face.Vertex[k])]); };
    const double volume = Dot(at(0), Cross(at(1), at(2))) / 6.;
    const int side = static_cast<int>(2 * f);
    volumes[{ face.Behind, parts.Find(side) }] += volume;
    volumes[{ face.Front, parts.Find(side + 1) }] -= volume;
    ++surfaces[face.Behind].Faces;
    ++surfaces[face.Front].Faces;
  }
  for (const auto& [part, volume] : volumes)
  {
    SurfaceTopology& surface = surfaces[part.first];
    ++(volume > 0. ? surface.Positive : surface.Negative);
    surface.Volume += volume;
  }
  surfaces.erase(surfaces.lower_bound(mesh.FirstSide), surfaces.end());
  return surfaces;
}
}

#endif
