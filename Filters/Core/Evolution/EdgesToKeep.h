// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgesToKeep_h
#define volumicEdgesToKeep_h

#include "Core/Common/Communicator.h"
#include "Core/Evolution/MeshPiece.h"
#include "Core/Mesh/Division.h"
#include "Core/Surface/Proximity.h"

#include <array>
#include <map>
#include <vector>

namespace volumic
{
/** Of a division: finds edges that are to be kept, by all ranks together. */
class EdgesToKeep
{
public:
  /** More and more edges are kept in these, until none is flipped in the last. */
  static constexpr int Rounds = 6;

  EdgesToKeep(
    Communicator& ranks, const MeshPiece& piece, const DivisionNumbers& numbers, KeptEdges& kept)
    : Ranks(ranks), Piece(piece), Numbers(numbers), Kept(kept)
  {
  }

  /**
   * Keeps the edges whose flips made faces that intersect; from the second round on others about
   * them, too, and all in the last one; then those at rings that would overflow.
   * @param pairs the same on all ranks, as the next are
   */
  void KeepAbout(const std::vector<Proximity::FacePair>& pairs, int round);

private:
  using Face = std::array<int, 3>;
  struct NumberedFace
  {
    int Number;
    Face Corners;
  };
  bool IsCentre(int v) const
  {
    const int olds = this->Piece.Mesh.Size();
    return v >= olds && v < olds + this->Numbers.Faces;
  }
  /** @return those of the old faces of which new corners of pairs are the centres, by centre */
  std::map<int, Face> FindFaces(const std::vector<Proximity::FacePair>& pairs) const;
  void FindOwn(int centre, std::vector<NumberedFace>& found) const;
  /** Keeps all edges at some vertices. @return the other ends of these */
  std::vector<int> KeepAllAt(const std::vector<int>& vertices);

  Communicator& Ranks;
  const MeshPiece& Piece;
  const DivisionNumbers& Numbers;
  KeptEdges& Kept;
};
}

#endif
