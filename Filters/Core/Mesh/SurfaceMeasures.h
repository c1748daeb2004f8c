// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceMeasures_h
#define volumicSurfaceMeasures_h

#include "Core/Common/Box.h"
#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * The signed volume that a closed surface, or some components of one, encloses; negative for what
 * is inside out. It is added up vertex by vertex: of the tetrahedron that a face spans with the
 * origin a third belongs to each corner.
 */
class SignedVolume
{
public:
  /** The origin may be any point; one of the surface costs no digits. */
  explicit SignedVolume(const Vector& origin = Vector()) : Origin(origin) {}

  /** Adds the share of a vertex; that of one that is not alive is 0. */
  void Add(const SurfaceMesh& mesh, int v)
  {
    this->Eighteenfold += OfVertex(mesh, this->Origin, v);
  }

  double Value() const { return this->Eighteenfold / 18.; }

  /** Eighteen times the share of an alive vertex. */
  static double OfVertex(const SurfaceMesh& mesh, const VectorD& origin, int v)
  {
    const Ring& ring = mesh.Rings[v];
    VectorD fan;
    for (int i = 0; i < ring.Count; ++i)
    {
      fan += Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
        VectorD(mesh.Position[ring.Next(i)]) - origin);
    }
    // Six times the tetrahedra of its faces, each of which is seen from three corners.
    return Dot(VectorD(mesh.Position[v]) - origin, fan);
  }
  /** Six times the share of a face, which is that of its corners together. */
  static double OfFace(const SurfaceMesh& mesh, const VectorD& origin, int a, int b, int c)
  {
    return Dot(VectorD(mesh.Position[a]) - origin,
      Cross(VectorD(mesh.Position[b]) - origin, VectorD(mesh.Position[c]) - origin));
  }

private:
  friend double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor);
  VectorD Origin;
  double Eighteenfold = 0.;
};

/** The signed volume of all components, workspace. The same bits for any executor. */
double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor);

/** What the vertices lie in, workspace; a box about the origin where there are none. */
Box BoundsOf(const SurfaceMesh& mesh, Executor& executor);

/** A third of the area of the faces about a vertex; 0 if it is not alive. */
double AreaShare(const SurfaceMesh& mesh, int v);
}

#endif
