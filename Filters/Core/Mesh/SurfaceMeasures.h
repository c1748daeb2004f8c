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
 * is inside out. It is added up vertex by vertex, where of the tetrahedron that a face spans with
 * the origin a third belongs to each corner, or face by face.
 */
class SignedVolume
{
public:
  /** The origin may be any point; one of the surface costs no digits. */
  explicit SignedVolume(const Vector& origin = Vector()) : Origin(origin) {}

  /** Adds the share of an alive vertex. */
  void Add(const SurfaceMesh& mesh, int v)
  {
    const Ring& ring = mesh.Rings[v];
    VectorD fan;
    for (int i = 0; i < ring.Count; ++i)
    {
      fan += Cross(VectorD(mesh.Position[ring.Item[i]]) - this->Origin,
        VectorD(mesh.Position[ring.Next(i)]) - this->Origin);
    }
    // Six times the tetrahedra of its faces, each of which is seen from three corners.
    this->Eighteenfold += Dot(VectorD(mesh.Position[v]) - this->Origin, fan);
  }

  /** Adds a whole face, instead of the shares of its corners. */
  void AddFace(const SurfaceMesh& mesh, int a, int b, int c)
  {
    this->Eighteenfold += 3. *
      Dot(VectorD(mesh.Position[a]) - this->Origin,
        Cross(VectorD(mesh.Position[b]) - this->Origin, VectorD(mesh.Position[c]) - this->Origin));
  }

  /** Adds what another one of the same origin has added up. */
  void Add(const SignedVolume& other) { this->Eighteenfold += other.Eighteenfold; }

  double Value() const { return this->Eighteenfold / 18.; }

private:
  friend double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor);
  VectorD Origin;
  double Eighteenfold = 0.;
};

/** The signed volume of all components, workspace. The same bits for any executor. */
double EnclosedVolume(const SurfaceMesh& mesh, Executor& executor);

/** What the vertices lie in, workspace; a box about the origin where there are none. */
Box BoundsOf(const SurfaceMesh& mesh, Executor& executor);

/** The area of all faces, workspace. The same bits for any executor. */
double SurfaceArea(const SurfaceMesh& mesh, Executor& executor);
}

#endif
