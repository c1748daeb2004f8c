// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceMesh_h
#define volumicSurfaceMesh_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Common/Vector.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
/** Of a closed surface of triangles: E = 3 (V - chi), soon more than an int counts. */
constexpr std::int64_t NumberOfEdges(std::int64_t vertices, std::int64_t eulerCharacteristic)
{
  return 3 * (vertices - eulerCharacteristic);
}

/**
 * The neighbours of a vertex, counter-clockwise seen from outside. A whole ring is one cache line,
 * which is what bounds the valence.
 */
struct alignas(64) Ring
{
  static constexpr int Capacity = 15;

  int Count = 0; ///< The valence; 0 marks an index that no vertex has.
  int Item[Capacity];

  /** Position of a neighbour in the ring, -1 where it is none. */
  int Find(int vertex) const
  {
    for (int i = 0; i < this->Count; ++i)
    {
      if (this->Item[i] == vertex)
      {
        return i;
      }
    }
    return -1;
  }
  bool Contains(int vertex) const { return this->Find(vertex) >= 0; }
  int Next(int i) const { return this->Item[i + 1 < this->Count ? i + 1 : 0]; }
  int Previous(int i) const { return this->Item[i > 0 ? i - 1 : this->Count - 1]; }
  /** The neighbour that follows `vertex`, which must be one. */
  int After(int vertex) const { return this->Next(this->Find(vertex)); }
  int Before(int vertex) const { return this->Previous(this->Find(vertex)); }

  void Replace(int from, int to) { this->Item[this->Find(from)] = to; }
  void Remove(int vertex)
  {
    for (int i = this->Find(vertex); i + 1 < this->Count; ++i)
    {
      this->Item[i] = this->Item[i + 1];
    }
    --this->Count;
  }
  void InsertAfter(int vertex, int added)
  {
    const int at = this->Find(vertex) + 1;
    for (int i = this->Count; i > at; --i)
    {
      this->Item[i] = this->Item[i - 1];
    }
    this->Item[at] = added;
    ++this->Count;
  }
};

/**
 * The places that edits take for new vertices, and those of the vertices that they remove, where
 * edits are made side by side and must not all use the mesh's own list of free places.
 */
struct VertexPlaces
{
  std::vector<int> Free;    ///< Places without a vertex; new vertices take them from the back.
  std::vector<int> Removed; ///< Places that must not be taken before the pass is over.
};

/** Places that follow each other and have never been taken. */
struct UnusedPlaces
{
  int Next = 0;
  int End = 0;
  int Count() const { return this->End - this->Next; }
};

/**
 * A closed oriented triangulated mesh, possibly of several components.
 *
 * The rings alone are the connectivity: the faces are the triangles (v, ring[i], ring[i + 1]).
 * There are no face or edge records to keep up to date, and a vertex finds all it needs for the
 * forces in two cache lines. Indices are stable; those of removed vertices are used again.
 */
class SurfaceMesh
{
public:
  LargeVector<Vector> Position;
  LargeVector<Ring> Rings;

  /** Indices, of alive vertices or not, run below this. */
  int Size() const { return static_cast<int>(this->Rings.size()); }
  /** Alive ones; those of places that are aside as CountOthers() has told. */
  int NumberOfVertices() const
  {
    return this->Size() - static_cast<int>(static_cast<std::int64_t>(this->Free.size()) + this->Aside);
  }
  bool IsAlive(int v) const { return this->Rings[v].Count > 0; }
  bool AreNeighbours(int u, int v) const { return this->Rings[u].Contains(v); }

  /**
   * Whether two different vertices are far apart on the surface: at least four edges, or not
   * connected at all.
   */
  bool AreFarApart(int v, int w) const;

  /**
   * @param places where its index comes from, which must have one; null: the mesh's own, which
   *               grows where it has none.
   * @return the index of a new vertex; its ring is the caller's to fill before anything else.
   */
  int AddVertex(const Vector& position, VertexPlaces* places = nullptr);
  /** @param places where its index goes; null: to the mesh's own. */
  void RemoveVertex(int v, VertexPlaces* places = nullptr);

  /**
   * Room for so many more vertices, in places that follow the last ones and are aside. They take
   * no memory before they are used.
   */
  UnusedPlaces AddUnusedPlaces(int n);
  /** Puts all free places aside, so that only their keeper uses them. */
  void PutAside(VertexPlaces& places);
  /** Takes these places back from their keeper: any new vertex may have them. */
  void FreeFromAside(VertexPlaces& places, const UnusedPlaces& unused);
  /** Counts vertices that came from, or went to, places aside. */
  void CountOthers(int more) { this->Aside -= more; }

  /** Calls visit(a, b, c) once for each face, counter-clockwise, a the smallest index. */
  template <typename Visitor>
  void VisitFaces(Visitor&& visit) const
  {
    this->VisitFaces(0, this->Rings.size(), visit);
  }
  /** The same for the faces whose smallest index is in a range: those of all ranges are all. */
  template <typename Visitor>
  void VisitFaces(std::size_t begin, std::size_t end, Visitor&& visit) const
  {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
    {
      const Ring& ring = this->Rings[v];
      for (int i = 0; i < ring.Count; ++i)
      {
        const int b = ring.Item[i];
        const int c = ring.Next(i);
        if (v < b && v < c)
        {
          visit(v, b, c);
        }
      }
    }
  }
  /** How many these are. */
  std::size_t CountFaces(std::size_t begin, std::size_t end) const
  {
    std::size_t count = 0;
    this->VisitFaces(begin, end, [&count](int, int, int) { ++count; });
    return count;
  }

  std::int64_t NumberOfFaces(Executor& executor = OnThisThread()) const;
  /** V - E + F, counted now. */
  int CountEulerCharacteristic(Executor& executor = OnThisThread()) const;

  /** All alive vertices, in order of index. */
  IndexedSurface ToIndexed(Executor& executor = OnThisThread()) const;

  /**
   * Adds the components of a closed oriented manifold triangle mesh.
   * @return index of the first vertex added; the rest follow in order.
   * @throws std::invalid_argument if it is not closed, oriented and manifold, or a vertex has
   * more neighbours than a ring holds.
   */
  int Append(const IndexedSurface& surface, Executor& executor = OnThisThread());

  /** Renumbers: vertex i of the result is order[i] of before; all alive ones must occur once. */
  void Reorder(const std::vector<int>& order, Executor& executor = OnThisThread());

  void Clear();
  /** Empties it; of n places, which take no memory, all are aside but those of some vertices. */
  void Remake(std::size_t n, int vertices);

  /** The places that no vertex has, the next one to be taken at the end, as a copy needs them. */
  const std::vector<int>& FreePlaces() const { return this->Free; }
  void SetFreePlaces(std::vector<int> places) { this->Free = std::move(places); }

private:
  std::vector<int> Free;
  std::int64_t Aside = 0; ///< Places that are neither free nor a vertex's.
};

/** The alive vertices along a Z-order (Morton) curve with cells of side `cell`, those of one by index. */
std::vector<int> SpaceFillingOrder(
  const SurfaceMesh& mesh, double cell, Executor& executor = OnThisThread());
}

#endif
