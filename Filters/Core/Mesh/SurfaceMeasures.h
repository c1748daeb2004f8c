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
 * Accumulates the signed volume enclosed by a closed surface, or by some of its components, vertex
 * by vertex. Each face spans a tetrahedron with the origin, a third of which is assigned to each of
 * its corners. The volume is negative if the surface is inside out.
 */
class SignedVolume
{
public:
  /** Set the origin, which may be any point. A point of the surface reduces rounding. */
  explicit SignedVolume(const Vector& origin = Vector()) : Origin(origin) {}

  /** Add the contribution of a vertex, which is 0 if it is not alive. */
  void Add(const SurfaceMesh& mesh, int v)
  {
    this->Eighteenfold += OfVertex(mesh, this->Origin, v);
  }

  double Value() const { return this->Eighteenfold / 18.; }

  /** Return 18 times the contribution of an alive vertex. */
  static double OfVertex(const SurfaceMesh& mesh, const VectorD& origin, int v)
  {
    const Ring& ring = mesh.Rings[v];
    VectorD fan;
    for (int i = 0; i < ring.Count; ++i)
    {
      fan += Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
        VectorD(mesh.Position[ring.Next(i)]) - origin);
    }
    // 6 times the volume of the tetrahedra of its faces, each of which has three corners.
    return Dot(VectorD(mesh.Position[v]) - origin, fan);
  }
  /** Return 6 times the contribution of a face, which is that of its three corners together. */
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

/** Return the signed volume of all components. Bit-identical for any executor. */
double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor);

/** Return the bounding box of the alive vertices, or a box at the origin if there are none. */
Box BoundsOf(const SurfaceMesh& mesh, Executor& executor);

/** Return a third of the area of the faces at a vertex, 0 if it is not alive. */
double VertexArea(const SurfaceMesh& mesh, int v);
}

#endif
