// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceState_h
#define volumicSurfaceState_h

#include "Core/Common/Executor.h"
#include "Core/Image/ImageMargin.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "Core/Mesh/VertexGrid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Lengths of the constraints of eq. (1), in delta. */
namespace constraint
{
constexpr float LongestEdge = 2.5f;
/** lambda: circumradius of the largest legal triangle. */
constexpr float NearestOthers = 1.4433757f;
/** Two triangles of legal edges that meet have two corners nearer than this. */
constexpr float Reach = 1.8f;
/** Rest length of the springs. */
constexpr float RestLength = 1.6f;
/** Triangles nearer than this count as meeting. */
constexpr double Contact = 1e-4;
}

/** What has been done to the connectivity since it was last reset. */
struct EditCounts
{
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  int Removed = 0; ///< Components deleted.
  int RemovedGenus = 0; ///< Sum of their genera.
};

/**
 * The live surface: mesh, proximity grid and what each vertex knows, as a structure of arrays
 * indexed like the mesh. Whoever adds or removes a vertex does it here, so that all stay in step.
 */
class SurfaceState
{
public:
  SurfaceMesh Mesh;
  VertexGrid Grid;
  float Delta = 1;
  ImageMargin Around; ///< Of the level: no vertex is moved further out.
  int EulerCharacteristic = 0; ///< Kept by the operations; tests hold it against a count.
  EditCounts Counts;

  std::vector<Vector> Velocity;
  std::vector<Vector> Normal;  ///< Unit; the fourth lane holds the cosine of the cone, see Shape.
  std::vector<Vector> Pull;    ///< Barycentre of the neighbours minus position; fourth lane: area.
  std::vector<Vector> Spring;  ///< Sum of the springs' pulls.
  std::vector<Vector> Before;  ///< Position before the last displacement: free of intersections.
  std::vector<Vector> Anchor;  ///< Where it was when last it had moved visibly.
  std::vector<float> Value;    ///< Field at the vertex, when last evaluated.
  std::vector<float> EdgeSum;  ///< Of the lengths of its edges, found by UpdateShape.
  std::vector<float> Moved;    ///< Way gone in this iteration.
  std::vector<float> Drift;    ///< Way its star has gone since it was last examined.
  std::vector<float> Slack;    ///< Room it had then between its star and others, see Proximity.
  std::vector<std::uint8_t> Slow; ///< Little of it would be used up in an iteration like the last.
  std::vector<int> Component;  ///< Label, kept by ComponentWatch.
  std::vector<std::uint8_t> Awake;
  std::vector<std::uint8_t> Quiet; ///< Iterations since it has moved visibly.
  std::vector<std::uint8_t> Stuck; ///< Grows with each roll back, shrinks otherwise.
  std::vector<std::uint8_t> Near;  ///< Something that is not smooth surface lies within reach.
  std::vector<std::uint8_t> Wants; ///< Bits of Wish, found by UpdateShape.

  enum Wish : std::uint8_t
  {
    Shorter = 1, ///< An edge is too long.
    Longer = 2,  ///< An edge is too short.
    Flip = 4     ///< An edge is not locally Delaunay.
  };

  /** Vertices whose ring or position has been edited since the list was last emptied. */
  std::vector<int> Touched;

  /** Sizes all arrays to the mesh, wakes everything, lays the grid over the box. */
  void Reset(const Vector& low, const Vector& high);

  void Adopt(int v, int parent); ///< Sizes the arrays for v, which behaves like its parent.
  void Forget(int v);            ///< Before v is removed from the mesh.
  void MoveTo(int v, const Vector& position)
  {
    this->Mesh.Position[v] = position;
    this->Grid.Move(v, position);
  }
  void Touch(int v)
  {
    this->Touched.push_back(v);
    this->Wake(v);
  }
  void Wake(int v)
  {
    this->Awake[v] = 1;
    this->Quiet[v] = 0;
  }

  /** Normal, cone, internal pulls and wishes of the vertices, from the positions as they are. */
  void UpdateShape(const std::vector<int>& vertices, Executor& executor);
  void UpdateShape(int v);

  /** Deletes the whole component of a vertex. @return the number of vertices removed. */
  int RemoveComponent(int v);

  /**
   * False where the normals of the faces about v and w all lie in a common cone, so that none of
   * the faces of one can be what a face of the other meets first. v == w asks about its own star.
   */
  bool AreOpposed(int v, int w) const
  {
    const Vector& n = this->Normal[v];
    const Vector& m = this->Normal[w];
    const float cv = n.Unused;
    const float cw = m.Unused;
    const float sv = std::sqrt(std::max(0.f, 1 - cv * cv));
    const float sw = std::sqrt(std::max(0.f, 1 - cw * cw));
    const float cosine = cv * cw - sv * sw; // of the sum of the two cones' angles
    const float sine = sv * cw + cv * sw;
    // Opposed if the angle between the normals and both cones add up to over 150 degrees.
    if (cosine < -0.8660254f || cv < 0 || cw < 0)
    {
      return true;
    }
    return Dot(n, m) < -0.8660254f * cosine + 0.5f * sine;
  }

private:
  std::vector<int> Stack;
};
}

#endif
