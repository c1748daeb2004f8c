// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgesToKeep_h
#define volumicEdgesToKeep_h

#include "Core/Mesh/Division.h"
#include "Core/Surface/Proximity.h"

#include <array>
#include <vector>

namespace volumic
{
/** Of a division: finds edges that are to be kept. */
class EdgesToKeep
{
public:
  /** More and more edges are kept in these, until none is flipped in the last. */
  static constexpr int Rounds = 6;

  EdgesToKeep(const SurfaceMesh& mesh, const DivisionNumbers& numbers, KeptEdges& kept)
    : Mesh(mesh), Numbers(numbers), Kept(kept)
  {
  }

  /**
   * Keeps the edges whose flips made faces that intersect; from the second round on others about
   * them, too, and all in the last one; then those at rings that would overflow.
   */
  void KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round);

private:
  using Face = std::array<int, 3>;
  bool IsCentre(int v) const
  {
    const int olds = this->Mesh.Size();
    return v >= olds && v < olds + this->Numbers.Faces;
  }
  /** The old face that a new vertex is the centre of. */
  Face FaceOf(int centre) const;
  /** Keeps the edges of old faces of which corners of a new one are the centres. @return their corners */
  std::vector<int> KeepOf(const Face& face);

  const SurfaceMesh& Mesh;
  const DivisionNumbers& Numbers;
  KeptEdges& Kept;
};
}

#endif
