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
/** Of the angle between the normals of one sheet and their mean: less than 84 degrees. */
constexpr double LeastSheetCosine = 0.1;

/** Corners of a triangle that there is not yet, and the vertices that they are. */
MeshTriangle TriangleOf(const InterfaceMesh& mesh, const std::array<int, 3>& vertices);

/** A face that there is, or may be. */
struct FaceCoordinates : MeshTriangle
{
  LabelMap::Number Behind;
  LabelMap::Number Front;
};
FaceCoordinates FaceCoordinatesOf(const InterfaceMesh& mesh, const InterfaceMesh::Face& face);

/** What a triangle lies in. */
Box BoxOf(const MeshTriangle& triangle);

/** From the edge (u, v) of a triangle to its third corner, across the edge; no unit length. */
VectorD AcrossEdge(const MeshTriangle& face, int u, int v);

/**
 * Whether faces that share an edge are about it in the order that their objects want: what one has
 * on its one side the next one has on that side, too. Where one has been turned past another,
 * objects overlap, though nothing intersects.
 */
bool AreInOrder(int u, int v, const std::vector<FaceCoordinates>& faces);

/**
 * Whether two faces at an edge have been turned past each other: a flat part passes through itself
 * so, and is inside out, though nothing intersects before nor afterwards.
 * @param u, v the edge
 * @param before, after the faces' corners; each of them turns by less than a right angle
 */
bool HavePassed(int u, int v, const std::array<MeshTriangle, 2>& before,
  const std::array<MeshTriangle, 2>& after);

/** What the boxes of faces are like. */
struct FaceBoxes
{
  Box All;
  float Longest = 0.f; ///< side of a box
  double Sides = 0.;   ///< sum of the longest side of each
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

/** @param boxOf Box(int face), of each face that is there, called by threads */
template <typename BoxOfFace>
FaceBoxes FindBoxes(
  const InterfaceMesh& mesh, std::size_t spanSize, Executor& executor, BoxOfFace&& boxOf)
{
  std::vector<FaceBoxes> ofSpans((mesh.Faces.size() + spanSize - 1) / spanSize);
  ForSpans(executor, mesh.Faces.size(), spanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        if (mesh.Faces[f].IsThere())
        {
          const Box box = boxOf(static_cast<int>(f));
          const float side = LongestSide(box);
          ofSpans[span].Add({ box, side, side, 1 });
        }
      }
    });
  FaceBoxes all;
  for (const FaceBoxes& some : ofSpans)
  {
    all.Add(some);
  }
  return all;
}

/** Which triangles of interfaces are near others, and whether they intersect them. */
class InterfaceClearance
{
public:
  /**
   * @param mesh must outlive it
   * @param tolerance triangles nearer than that count as intersecting
   */
  InterfaceClearance(const InterfaceMesh& mesh, double tolerance);

  /** Lays its grid afresh. */
  void Reset(Executor& executor);
  /**
   * To be called of each face that has another corner, a corner elsewhere, or is removed. Threads
   * may do so at the same time, and ask about faces, if none finds what another one changes, nor
   * something in the same cells of the grid; and if no edge becomes longer than was expected.
   */
  void Change(int face);
  void ExpectEdges(float longest) { this->Reach = std::max(this->Reach, 0.5f * longest); }

  /** Of a face that is there. */
  const Box& BoxOf(int face) const { return this->Boxes[static_cast<std::size_t>(face)]; }
  /** Of all faces when the grid was laid. */
  const Box& Bounds() const { return this->All; }

  /** Faces whose boxes come near a box. */
  void FindNear(const Box& box, std::vector<int>& near) const;
  /** A face that this one intersects; -1: none. @param near room for it */
  int FindIntersecting(int face, std::vector<int>& near) const;
  /**
   * Whether faces may take the place of some: they intersect nothing else, nor each other, are in
   * order at junction lines, and pass nothing that they share an edge with. @param near room for it
   */
  bool AreClear(const std::vector<FaceCoordinates>& faces, const std::vector<int>& replaced,
    std::vector<int>& near) const;

private:
  /** Faces between two objects that may come, and those near, also those that would go. */
  struct Sheet
  {
    LabelMap::Number Behind;
    LabelMap::Number Front;
    VectorD Along;
    bool IsOne = true; ///< They all face about one way, see FindCrossings: none intersects others.
    bool IsAlone = true; ///< None near is between other objects.

    template <typename AnyFace>
    bool Has(const AnyFace& face) const
    {
      return face.Behind == this->Behind && face.Front == this->Front;
    }
  };
  std::vector<Sheet> FindSheets(
    const std::vector<FaceCoordinates>& faces, const std::vector<int>& near) const;
  /** Whether one of its edges may be of a junction line. */
  bool IsAtLine(const FaceCoordinates& face) const;
  /** @param others faces that stay, among them all that share an edge with these */
  bool AreInOrderAtLines(
    const std::vector<FaceCoordinates>& faces, const std::vector<int>& others) const;

  /** Whether one of these comes past a face that stays, about an edge that stays where it is. */
  bool PassAny(const std::vector<FaceCoordinates>& faces, const std::vector<int>& replaced) const;

  const InterfaceMesh& Mesh;
  double Tolerance;
  LargeVector<Box> Boxes; ///< of each face, which the grid has at its middle
  Box All;                ///< of them when the grid was laid
  float Reach = 0.f;      ///< half of the longest side of a box, at least
  VertexGrid Grid;
};
}

#endif
