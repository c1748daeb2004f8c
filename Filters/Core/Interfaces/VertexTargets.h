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
/** Maximum length of a step of a vertex, relative to its shortest edge. */
constexpr double MostOfEdge = 0.5;

/** Maximum distance of junction line vertices from the lines of the fields, computational space. */
constexpr double MostStraightening = 0.3;

/**
 * Computes the target positions of vertices in a step. A vertex moves along its interface or
 * junction line towards the middle of its neighbours (tangential smoothing). It then moves to the
 * position at which the fields of all adjacent objects are equal (Newton step). Vertices of
 * junction lines are finally moved towards a straight line.
 */
class VertexTargets
{
public:
  /**
   * Lengths are in computational space.
   * @param relaxation    fraction of the tangential smoothing step
   * @param shortest      no edge is made shorter than this length
   * @param straightening maximum distance by which vertices of junction lines are straightened
   * @param mostOfEdge    maximum length of a step, relative to the shortest edge of the vertex
   */
  VertexTargets(const InterfaceMesh& mesh, const InterfaceFields& fields, double relaxation,
    double shortest, double straightening = MostStraightening, double mostOfEdge = MostOfEdge)
    : Mesh(mesh), Fields(fields), Relaxation(static_cast<float>(relaxation)),
      Most(static_cast<float>(mostOfEdge)), Shortest(static_cast<float>(shortest)),
      Straightest(static_cast<float>(straightening))
  {
  }

  Vector TargetOf(int v);

private:
  /** Find the objects at a vertex, and the axes along which sides of a box allow it to move. */
  void FindObjects(int v);
  VectorD AlongSides(const VectorD& step) const
  {
    return { step.X * this->Free[0], step.Y * this->Free[1], step.Z * this->Free[2] };
  }
  /** Return whether a move makes an edge too short if the neighbour moves likewise. */
  bool Shortens(const Vector& position, const Vector& target) const;
  /** Return the tangential vector to the area-weighted mean of the faces. */
  Vector AlongInterface(int v) const;
  /** Return the tangential vector to the middle of both neighbours on the line; 0 at a corner. */
  Vector AlongLine(int v) const;
  /**
   * Return the displacement towards the straight line between both neighbours on the line. At a
   * corner: towards the mean of its neighbours on all lines.
   */
  Vector Straightening(const Vector& position) const;
  Vector MiddleOfEnds() const;
  void FindEnds();
  /** Return the shortest step that makes the fields of all adjacent objects equal. */
  Vector ToInterfaces(const Vector& position) const;

  const InterfaceMesh& Mesh;
  const InterfaceFields& Fields;
  float Relaxation;
  float Most; ///< maximum step, relative to the shortest edge
  float Shortest;
  float Straightest;
  std::vector<int> Neighbours; ///< of the current vertex
  std::vector<int> Objects;    ///< adjacent objects, without sides of a box
  std::array<double, 3> Free;  ///< 1 for each free axis, 0 for the normal of a side at the vertex
  std::vector<Vector> Ends;    ///< positions of the neighbours on junction lines
};
}

#endif
