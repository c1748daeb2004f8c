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
 * Stratum of a vertex. Three or more interfaces meet at a junction line, and junction lines end at
 * junction points (Corner).
 */
enum class Stratum : unsigned char
{
  Interface = 0,
  Line = 1,
  Corner = 2
};

/**
 * Non-manifold triangle mesh of the interfaces between the objects of a label map. Each triangle
 * separates two objects, and any number of triangles may share an edge. The triangles of one object
 * form a closed manifold surface. Lengths are in computational space.
 *
 * Objects may end at the sides of a box. Sides are numbered after the objects: x-min, x-max, y-min,
 * y-max, z-min, z-max. A face with a side in front lies exactly in the plane of this side. There
 * are no faces between two sides, or between a side and object 0. Hence the edges of the box, and
 * the boundaries of objects on a side, may be lines with only two triangles.
 */
class InterfaceMesh
{
public:
  struct Face
  {
    std::array<int, 3> Vertex; ///< counter-clockwise seen from Front; Vertex[0] is -1 if removed
    LabelMap::Number Behind;   ///< object
    LabelMap::Number Front;    ///< object or side with a larger number than Behind

    bool IsThere() const { return this->Vertex[0] >= 0; }
    bool Has(int v) const
    {
      return this->Vertex[0] == v || this->Vertex[1] == v || this->Vertex[2] == v;
    }
    /** Return the third vertex of a face that has the vertices u and v. */
    int Opposite(int u, int v) const
    {
      return this->Vertex[0] + this->Vertex[1] + this->Vertex[2] - u - v;
    }
  };

  LargeVector<Vector> Position;
  LargeVector<Stratum> StratumOf;
  /** Desired edge length at each vertex, relative to the basic edge length. */
  LargeVector<float> Size;
  LargeVector<Face> Faces;
  /** As LabelMap::WholeOf. Parts of one object never share a vertex. */
  std::vector<LabelMap::Number> WholeOf;
  int Whole(int object) const
  {
    return static_cast<std::size_t>(object) < this->WholeOf.size()
      ? this->WholeOf[static_cast<std::size_t>(object)]
      : object;
  }
  /** Number of the side x-min. */
  int FirstSide = std::numeric_limits<int>::max();
  std::array<float, 6> Planes = { -Infinite, Infinite, -Infinite, Infinite, -Infinite, Infinite };

  bool IsSide(int object) const { return object >= this->FirstSide; }
  int AxisOf(int side) const { return (side - this->FirstSide) / 2; }
  float PlaneOf(int side) const
  {
    return this->Planes[static_cast<std::size_t>(side - this->FirstSide)];
  }
  /** Project a position into the box, and into the planes of the sides that a vertex lies on. */
  Vector ProjectToSides(int v, const Vector& position) const;

  /**
   * Next image of each vertex, as a cyclic list. In a periodic box each vertex on a side has an
   * image on the opposite side, with bit-identical coordinates along the side, and so do edges and
   * faces. The number of images is 2 in a side, 4 on an edge and 8 at a corner of the box. A vertex
   * without other images is its own image.
   */
  LargeVector<int> NextImage;
  bool HasImages(int v) const { return this->NextImage[static_cast<std::size_t>(v)] != v; }
  /** Find all images by position. @throws std::logic_error if opposite sides do not match */
  void MatchSides();
  int NumberOfImages(int v) const; ///< includes v itself
  /** Find the images of an edge (u, v), or of a vertex (v, v), itself first. */
  void FindImages(int u, int v, std::vector<std::array<int, 2>>& images) const;
  void JoinImages(const std::vector<int>& images);

  /** Replace the mesh. All sizes are 1; call FindStrata() afterwards. */
  void Assign(LargeVector<Vector> positions, LargeVector<Face> faces);
  int AddVertex(const Vector& position, Stratum stratum, float size = 1.f);
  int AddFace(const Face& face);
  void RemoveFace(int face);
  void ReplaceVertex(int face, int old, int vertex);

  bool IsVertex(int v) const { return this->Head[static_cast<std::size_t>(v)] >= 0; }

  /** Call visit(face) for the faces of a vertex; their order depends on previous edits. */
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
  /** Return whether the faces at an edge form a line: they are not two faces of one interface. */
  bool IsLine(const std::vector<int>& faces) const;
  void FindFaces(int u, int v, std::vector<int>& faces) const;
  bool HasEdge(int u, int v) const;
  /**
   * Find the sorted neighbours of a vertex. Each occurs once per face at its edge, neighbours along
   * a line at least three times.
   */
  void FindNeighbours(int v, std::vector<int>& neighbours) const;
  /** Call visit(w) for each neighbour along a line, given the result of FindNeighbours(). */
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
  /** Find the sorted objects and sides at a vertex. */
  void FindObjects(int v, std::vector<int>& objects) const;

  void FindStrata();

  /** Return the edges of junction lines, the lower vertex first. */
  std::vector<std::array<int, 2>> FindLines() const;

  std::vector<std::vector<int>> FindFacesOfObjects() const;
  /** Return the closed surface of an object and its parts; point n is the vertex vertices[n]. */
  IndexedSurface SurfaceOf(
    int object, const std::vector<int>& faces, std::vector<int>& vertices) const;

  /** Return the size of an edge (u, v), which need not exist. */
  float SizeOf(int u, int v) const
  {
    return 0.5f *
      (this->Size[static_cast<std::size_t>(u)] + this->Size[static_cast<std::size_t>(v)]);
  }

  VectorD NormalOf(const Face& face) const; ///< length: twice the area
  double MeanEdge() const;

  /** Delete removed elements from all arrays. @param isSorted sort vertices by Z, Y and X */
  void Compact(bool isSorted = false);

private:
  static constexpr float Infinite = std::numeric_limits<float>::infinity();

  void Link(int corner, int v);
  void Unlink(int corner, int v);

  // Corner number: 3 * face + index of the vertex in the face.
  LargeVector<int> Head; ///< last added corner of each vertex; -1: none
  LargeVector<int> Next; ///< next corner of the same vertex; -1: end
};
}

#endif
