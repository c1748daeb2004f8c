// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceMesh_h
#define volumicInterfaceMesh_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Common/Vector.h"
#include "Core/Labels/LabelMap.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace volumic
{
/**
 * What a vertex of interfaces lies on. Interfaces end at junction lines, where three of them or
 * more meet, and these at junction points.
 */
enum class Stratum : unsigned char
{
  Interface = 0,
  Line = 1,
  Corner = 2
};

/**
 * The interfaces of the objects of a label map: triangles between two objects each, of which any
 * number may share an edge. The triangles of an object, taken together, are a closed manifold
 * surface. Lengths: workspace.
 *
 * Objects may end at the sides of a box, which are numbered as objects are, after these: x-min,
 * x-max, y-min and so on. A face in front of which a side is lies in its plane, exactly. Sides have
 * no faces between each other, nor with object 0, so that the edges of the box, and the rims of its
 * faces, are lines with two triangles only.
 */
class InterfaceMesh
{
public:
  struct Face
  {
    std::array<int, 3> Vertex; ///< counter-clockwise seen from Front; the first -1: it is removed
    LabelMap::Number Behind;   ///< object
    LabelMap::Number Front;    ///< object, of a larger number

    bool IsThere() const { return this->Vertex[0] >= 0; }
    bool Has(int v) const
    {
      return this->Vertex[0] == v || this->Vertex[1] == v || this->Vertex[2] == v;
    }
    /** The third vertex, of a face that has both. */
    int Opposite(int u, int v) const
    {
      return this->Vertex[0] + this->Vertex[1] + this->Vertex[2] - u - v;
    }
  };

  LargeVector<Vector> Position;
  LargeVector<Stratum> StratumOf;
  /** By how much longer edges are wanted about a vertex than where they are shortest. */
  LargeVector<float> Size;
  LargeVector<Face> Faces;
  /** As LabelMap::WholeOf: parts of one object never get a vertex in common. */
  std::vector<LabelMap::Number> WholeOf;
  int Whole(int object) const
  {
    return static_cast<std::size_t>(object) < this->WholeOf.size()
      ? this->WholeOf[static_cast<std::size_t>(object)]
      : object;
  }
  /** The number of x-min. */
  int FirstSide = std::numeric_limits<int>::max();
  /** The planes of the sides. */
  std::array<float, 6> Planes = { -Infinite, Infinite, -Infinite, Infinite, -Infinite, Infinite };

  bool IsSide(int object) const { return object >= this->FirstSide; }
  int AxisOf(int side) const { return (side - this->FirstSide) / 2; }
  float PlaneOf(int side) const
  {
    return this->Planes[static_cast<std::size_t>(side - this->FirstSide)];
  }
  /** A place in the box, with a vertex's own coordinates along axes at whose sides it is. */
  Vector OnSides(int v, const Vector& place) const;

  /**
   * In a periodic box vertices on a side have images on the opposite one, with bits of two
   * coordinates in common, and so have the edges and faces there: 2 in a side, 4 in an edge of the
   * box, 8 in its corners. Those of a vertex are a ring of next ones; others are their own.
   */
  LargeVector<int> NextImage;
  bool HasImages(int v) const { return this->NextImage[static_cast<std::size_t>(v)] != v; }
  /** From the places of vertices. @throws std::logic_error where some have no image */
  void MatchSides();
  int NumberOfImages(int v) const; ///< itself among them
  /** Those of an edge (u, v), or of a vertex (v, v), itself first. */
  void FindImages(int u, int v, std::vector<std::array<int, 2>>& images) const;
  /** Makes a ring of vertices that are images of each other. */
  void JoinImages(const std::vector<int>& images);

  /** Takes these, in place of what it has, all sizes 1; strata are to be found. */
  void Assign(LargeVector<Vector> positions, LargeVector<Face> faces);
  int AddVertex(const Vector& position, Stratum stratum, float size = 1.f);
  int AddFace(const Face& face);
  void RemoveFace(int face);
  /** Has a face have another vertex in the place of one. */
  void ReplaceVertex(int face, int old, int vertex);

  bool IsVertex(int v) const { return this->Head[static_cast<std::size_t>(v)] >= 0; }

  /** Calls visit(face) for the faces of a vertex, in an order that the edits before have made. */
  template <typename Visitor>
  void ForFaces(int v, Visitor&& visit) const
  {
    for (int corner = this->Head[static_cast<std::size_t>(v)]; corner >= 0;)
    {
      const int next = this->Next[static_cast<std::size_t>(corner)];
      visit(corner / 3);
      corner = next;
    }
  }
  /** Whether the faces at an edge are those of a line: not two between the same objects. */
  bool IsLine(const std::vector<int>& faces) const;
  /** The faces at an edge. */
  void FindFaces(int u, int v, std::vector<int>& faces) const;
  bool HasEdge(int u, int v) const;
  /**
   * Other vertices of the faces of a vertex, sorted; each as often as there are faces at the edge,
   * but along lines at least three times.
   */
  void FindNeighbours(int v, std::vector<int>& neighbours) const;
  /** Calls visit(w) for each of these neighbours that is one along a line, in their order. */
  template <typename Visitor>
  static void ForLineNeighbours(const std::vector<int>& neighbours, Visitor&& visit)
  {
    for (std::size_t n = 0; n + 2 < neighbours.size(); ++n)
    {
      const int w = neighbours[n];
      if (neighbours[n + 2] == w && (n == 0 || neighbours[n - 1] != w))
      {
        visit(w);
      }
    }
  }
  /** The objects about a vertex, sorted. */
  void FindObjects(int v, std::vector<int>& objects) const;

  /** Of all vertices, by the faces at their edges. */
  void FindStrata();

  /** The edges of junction lines, the lower vertex first. */
  std::vector<std::array<int, 2>> FindLines() const;

  /** Of each object, from 0 on, its faces. */
  std::vector<std::vector<int>> FindFacesOfObjects() const;
  /**
   * The closed surface of an object, with all its parts, of its faces; vertices[n] is point n of
   * it.
   */
  IndexedSurface SurfaceOf(
    int object, const std::vector<int>& faces, std::vector<int>& vertices) const;

  /** Of an edge (u, v), which need not be there yet. */
  float SizeOf(int u, int v) const
  {
    return 0.5f *
      (this->Size[static_cast<std::size_t>(u)] + this->Size[static_cast<std::size_t>(v)]);
  }

  VectorD NormalOf(const Face& face) const; ///< twice the area long
  double MeanEdge() const;                  ///< of the faces' edges

  /** Takes what is removed out of all arrays. @param isSorted numbers vertices by Z, Y and X */
  void Compact(bool isSorted = false);

private:
  static constexpr float Infinite = std::numeric_limits<float>::infinity();

  void Link(int corner, int v);
  void Unlink(int corner, int v);

  LargeVector<int> Head; ///< of each vertex its last corner, 3 times the face and its place in it
  LargeVector<int> Next; ///< of each corner another one of the same vertex
};
}

#endif
