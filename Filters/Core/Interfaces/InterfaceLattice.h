// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceLattice_h
#define volumicInterfaceLattice_h

#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

namespace volumic
{
/**
 * First interfaces: those of the objects to which the points of a body-centred cubic lattice
 * belong. Each tetrahedron of the
 * lattice whose corners are of several objects is cut between these: with two objects by one
 * triangle or two, with more by a fan about a point inside it, from the curves that its faces show.
 * So neighbours agree on each face, and interfaces are closed, meet along lines only, and do not
 * intersect, by construction; the surface of each object is a manifold.
 *
 * It is multi-label marching tetrahedra. Vertices on edges are where the fields of their ends'
 * objects are the same, as far as a share of the edge keeps them from its ends.
 */
class InterfaceLattice
{
public:
  /**
   * The coarser one of two lattices: the centres of voxels and the middles between eight of them, or
   * every fourth voxel, of which the triangles of the start are about as large as voxels. That is
   * taken if it has a point near each voxel of an object, but for a few, and the wanted edges are
   * not shorter.
   * @param edge workspace
   */
  InterfaceLattice(const InterfaceFields& fields, double edge, Executor& executor);

  InterfaceMesh Start(Executor& executor) const;
  int Pitch() const { return this->Distance; }

private:
  const InterfaceFields& Fields;
  int Distance = 1; ///< of the cubes' corners, in voxels
};
}

#endif
