// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceClearance_h
#define volumicInterfaceClearance_h

#include "Core/Common/Box.h"
#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Mesh/VertexGrid.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/** Least cosine between the normals of a sheet and their mean (84 degrees). */
constexpr double LeastSheetCosine = 0.1;

/** Return the triangle of three vertices, which need not be a face of the mesh, or of a face. */
MeshTriangle TriangleOf(const InterfaceMesh& mesh, const std::array<int, 3>& vertices);
MeshTriangle TriangleAt(const InterfaceMesh& mesh, int face);

/** An existing or proposed face with its corner positions. */
struct FaceCoordinates : MeshTriangle
{
  LabelMap::Number Behind;
  LabelMap::Number Front;
};
FaceCoordinates FaceCoordinatesOf(const InterfaceMesh& mesh, const InterfaceMesh::Face& face);

Box BoxOf(const MeshTriangle& triangle);

/** Return the non-normalized vector from edge (u, v) to the third corner, normal to the edge. */
VectorD AcrossEdge(const MeshTriangle& face, int u, int v);

/**
 * Return whether the faces at an edge are in a consistent cyclic order: consecutive faces agree on
 * the object between them. If one face has been turned past another, objects overlap although no
 * triangles intersect.
 */
bool AreInOrder(int u, int v, const std::vector<FaceCoordinates>& faces);

/**
 * Return whether two faces at an edge have been turned past each other. A flat part is then inside
 * out although no triangles intersect before or after the move.
 * @param u, v the edge
 * @param before, after the two faces; each of them turns by less than 90 degrees
 */
bool HavePassed(int u, int v, const std::array<MeshTriangle, 2>& before,
  const std::array<MeshTriangle, 2>& after);

struct FaceBoxes
{
  Box All;
  float Longest = 0.f; ///< longest side
  double Sides = 0.;   ///< sum of the longest sides of the boxes
  std::size_t Count = 0;

  double MeanSide() const
  {
    return this->Sides / static_cast<double>(std::max<std::size_t>(this->Count, 1));
  }
  void Add(const FaceBoxes& others)
  {
    if (others.Count > 0)
    {
      this->All = this->Count == 0 ? others.All : this->All.With(others.All);
      this->Longest = std::max(this->Longest, others.Longest);
      this->Sides += others.Sides;
      this->Count += others.Count;
    }
  }
};

float LongestSide(const Box& box);

/** Return the statistics of all faces. @param boxOf Box(int face), called by several threads */
template <typename BoxOfFace>
FaceBoxes FindBoxes(
  const InterfaceMesh& mesh, std::size_t spanSize, Executor& executor, BoxOfFace&& boxOf)
{
  std::vector<FaceBoxes> perSpan((mesh.Faces.size() + spanSize - 1) / spanSize);
  ForSpans(executor, mesh.Faces.size(), spanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        if (mesh.Faces[f].IsThere())
        {
          const Box box = boxOf(static_cast<int>(f));
          const float side = LongestSide(box);
          perSpan[span].Add({ box, side, side, 1 });
        }
      }
    });
  FaceBoxes all;
  for (const FaceBoxes& some : perSpan)
  {
    all.Add(some);
  }
  return all;
}

/** Spatial search structure of interface triangles for proximity and intersection tests. */
class InterfaceClearance
{
public:
  /**
   * @param mesh must outlive this object
   * @param tolerance triangles at a smaller distance count as intersecting
   */
  InterfaceClearance(const InterfaceMesh& mesh, double tolerance);

  void Reset(Executor& executor);
  /**
   * Update a face after a change of its vertices or positions, or after its removal. Threads may
   * call this and query faces concurrently if they access different faces and different cells of
   * the grid, and if no edge becomes longer than ExpectEdges() states.
   */
  void Change(int face);
  /** Set a lower bound for the search radius: half the longest edge that edits may create. */
  void ExpectEdges(float longest) { this->Reach = std::max(this->Reach, 0.5f * longest); }

  const Box& BoxOf(int face) const { return this->Boxes[static_cast<std::size_t>(face)]; }
  /** Return the bounding box of all faces at the last Reset(). */
  const Box& Bounds() const { return this->All; }

  /** Find the faces whose boxes are within the tolerance of a box. */
  void FindNear(const Box& box, std::vector<int>& near) const;
  /** Return a face that intersects a face; -1: none. @param near scratch memory */
  int FindIntersecting(int face, std::vector<int>& near) const;
  /**
   * Return whether new faces may replace existing ones. They must not intersect each other or any
   * other face, must be in consistent order at junction lines (AreInOrder), and must not pass a
   * face at a common edge (HavePassed).
   * @param near scratch memory
   */
  bool AreClear(const std::vector<FaceCoordinates>& faces, const std::vector<int>& replaced,
    std::vector<int>& near) const;

private:
  /** The faces between two objects: the new ones and all near ones, replaced ones included. */
  struct Sheet
  {
    LabelMap::Number Behind;
    LabelMap::Number Front;
    VectorD Along;
    bool IsOne = true;   ///< All normals are similar, so that none intersect (FindCrossings).
    bool IsAlone = true; ///< No near face is between other objects.

    template <typename AnyFace>
    bool Has(const AnyFace& face) const
    {
      return face.Behind == this->Behind && face.Front == this->Front;
    }
  };
  std::vector<Sheet> FindSheets(
    const std::vector<FaceCoordinates>& faces, const std::vector<int>& near) const;
  /** Return whether an edge of a face may be on a junction line. */
  bool IsAtLine(const FaceCoordinates& face) const;
  /** @param others near faces that stay, including all that share an edge with new faces */
  bool AreInOrderAtLines(
    const std::vector<FaceCoordinates>& faces, const std::vector<int>& others) const;

  /** Return whether a new face has been turned past a face that stays, at an edge that stays. */
  bool PassAny(const std::vector<FaceCoordinates>& faces, const std::vector<int>& replaced) const;

  const InterfaceMesh& Mesh;
  double Tolerance;
  LargeVector<Box> Boxes; ///< box of each face; the grid stores the face at its middle
  Box All;                ///< bounding box at the last Reset()
  float Reach = 0.f;      ///< at least half of the longest side of all boxes
  VertexGrid Grid;
};
}

#endif
