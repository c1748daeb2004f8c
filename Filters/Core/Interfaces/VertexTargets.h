// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexTargets_h
#define volumicVertexTargets_h

#include "Core/Common/Vector.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <array>
#include <vector>

namespace volumic
{
/** How far a vertex may go in a step, in its shortest edge. */
constexpr double MostOfEdge = 0.5;

/** How far vertices of junction lines go from where the fields have them; workspace. */
constexpr double MostStraightening = 0.3;

/**
 * Where the vertices of interfaces go in a step: along their interface or junction line to the
 * middle of their neighbours, by a share of the way, then to where the fields of all objects about
 * them are the same (Newton), and no further than a share of their shortest edge.
 */
class VertexTargets
{
public:
  /**
   * @param shortest      no edge is made shorter than that; workspace
   * @param straightening how far vertices of junction lines go towards straight ones, at most;
   *                      workspace
   */
  VertexTargets(const InterfaceMesh& mesh, const InterfaceFields& fields, double share,
    double shortest, double straightening = MostStraightening, double mostOfEdge = MostOfEdge)
    : Mesh(mesh), Fields(fields), Share(static_cast<float>(share)),
      Most(static_cast<float>(mostOfEdge)),
      Shortest(static_cast<float>(shortest)), Straightest(static_cast<float>(straightening))
  {
  }

  Vector Of(int v);

private:
  /** The objects about it, and which ways it may go where sides of a box are among them. */
  void FindObjects(int v);
  VectorD AlongSides(const VectorD& way) const
  {
    return { way.X * this->Free[0], way.Y * this->Free[1], way.Z * this->Free[2] };
  }
  /**
   * Whether it would make an edge too short, if the neighbour did the same: two corners of the same
   * objects want to be in one place.
   */
  bool Shortens(const Vector& place, const Vector& target) const;
  /** To the middle of its faces, by their areas for their sizes, without what is across. */
  Vector AlongInterface(int v) const;
  /** To the middle of its two neighbours on the line, without what is across; 0 of a corner. */
  Vector AlongLine(int v) const;
  /**
   * From a place some way to the straight line between the neighbours on the junction line, of a
   * corner to the middle of its neighbours on all lines.
   */
  Vector Straightening(const Vector& place) const;
  Vector MiddleOfEnds() const;
  void FindEnds();
  /** The least step that makes the fields of all objects about it the same. */
  Vector ToInterfaces(const Vector& place) const;

  const InterfaceMesh& Mesh;
  const InterfaceFields& Fields;
  float Share;
  float Most; ///< of its shortest edge, what a vertex may go
  float Shortest;
  float Straightest;
  std::vector<int> Neighbours; ///< of the vertex that is looked at
  std::vector<int> Objects;    ///< about it, without sides of a box
  std::array<double, 3> Free;  ///< of each axis 1, or 0 where it is at a side across it
  std::vector<Vector> Ends;    ///< its neighbours on junction lines
};
}

#endif
