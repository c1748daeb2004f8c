// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceLattice_h
#define volumicInterfaceLattice_h

#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <array>

namespace volumic
{
/**
 * First interfaces: those of the objects to which the points of a body-centred cubic lattice
 * belong. Each tetrahedron of the lattice whose corners are of several objects is cut between
 * these: with two objects by one triangle or two, with more by a fan about a point inside it, from
 * the curves that its faces show. So neighbours agree on each face, and interfaces are closed, meet
 * along lines only, and do not intersect, by construction; the surface of each object is a
 * manifold.
 *
 * It is multi-label marching tetrahedra. Vertices on edges are where the fields of their ends'
 * objects are the same, as far as a share of the edge keeps them from its ends.
 */
class InterfaceLattice
{
public:
  /**
   * The lattice whose cubes have corners at all voxels, or, along axes where voxels are not too
   * long for the wanted edges, at every second one, if it has a point near each voxel of an object,
   * but for a few, and objects do not end at a box. Triangles of the start are then about as large
   * as they should be.
   * @param edge workspace
   */
  InterfaceLattice(const InterfaceFields& fields, double edge, Executor& executor);

  InterfaceMesh Start(Executor& executor) const;
  /** Of the cubes, along each axis, in voxels. */
  const std::array<int, 3>& Pitch() const { return this->Distances; }

private:
  const InterfaceFields& Fields;
  std::array<int, 3> Distances = { 1, 1, 1 };
};
}

#endif
