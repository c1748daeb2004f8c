// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceMesh_h
#define volumicSurfaceMesh_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Common/Vector.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
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
 * Places that follow each other, for the new vertices of edits that are made where others edit the
 * same mesh elsewhere; what is added and removed is counted here.
 */
struct VertexRoom
{
  int Next = 0;
  int End = 0;
  int Added = 0; ///< Vertices, less those removed.
  bool Has(int n) const { return this->End - this->Next >= n; }
};

/** In an order of vertices: a place without one. */
constexpr int NoVertex = -1;

/** Memory for values of vertices that are reordered; arrays of other types go through the rings'. */
template <typename T>
struct Spare
{
  LargeVector<T> Values;
};
struct VertexSpares : Spare<Ring>, Spare<Vector>, Spare<float>, Spare<std::uint8_t>
{
};

/**
 * A closed oriented triangulated mesh, possibly of several components.
 *
 * The rings alone are the connectivity: the faces are the triangles (v, ring[i], ring[i + 1]).
 * There are no face or edge records to keep up to date, and a vertex finds all it needs for the
 * forces in two cache lines. Indices are stable until Reorder(); those of removed vertices are not
 * used again before.
 */
class SurfaceMesh
{
public:
  LargeVector<Vector> Position;
  LargeVector<Ring> Rings;

  /** Indices, of alive vertices or not, run below this. */
  int Size() const { return static_cast<int>(this->Rings.size()); }
  /** Alive ones, of what was added and removed by way of a VertexRoom as Count() has told. */
  int NumberOfVertices() const { return this->Size() - this->Empty; }
  bool IsAlive(int v) const { return this->Rings[v].Count > 0; }
  bool AreNeighbours(int u, int v) const { return this->Rings[u].Contains(v); }

  /**
   * Whether two different vertices are far apart on the surface: at least four edges, or not
   * connected at all.
   */
  bool AreFarApart(int v, int w) const;

  /**
   * @param room where its index comes from, which must have one; null: it follows the last one.
   * @return the index of a new vertex; its ring is the caller's to fill before anything else.
   */
  int AddVertex(const Vector& position, VertexRoom* room = nullptr);
  /** @param room which counts it; null: it is counted here. */
  void RemoveVertex(int v, VertexRoom* room = nullptr);
  /** Counts what was added and removed by way of a room, once nobody uses it any more. */
  void Count(const VertexRoom& room) { this->Empty -= room.Added; }

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

  /**
   * Renumbers: vertex i of the result is order[i] of before, none where that is NoVertex; all alive
   * ones must occur once.
   * @param spares kept from one call to the next, as new memory takes longer than all that is copied
   */
  void Reorder(const std::vector<int>& order, VertexSpares& spares, Executor& executor);
  void Reorder(const std::vector<int>& order, Executor& executor = OnThisThread());

  void Clear();
  /** Makes it one of n vertices, whose positions and rings are the caller's to fill. */
  void Remake(std::size_t n);

private:
  int Empty = 0; ///< Places without a vertex.
};

/**
 * Brings values of vertices into a new order, see SurfaceMesh::Reorder; where there is no vertex
 * they are zero. The old values become the spare ones.
 */
template <typename T>
void Reorder(LargeVector<T>& values, const std::vector<int>& order, VertexSpares& spares,
  Executor& executor)
{
  constexpr bool isSwapped = std::is_base_of_v<Spare<T>, VertexSpares>;
  using OfSpare = std::conditional_t<isSwapped, T, Ring>;
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(OfSpare));
  constexpr std::size_t span = 16384;
  const std::size_t n = order.size();
  LargeVector<OfSpare>& spare = static_cast<Spare<OfSpare>&>(spares).Values;
  MakeRoom(spare, n);
  spare.resize(n);
  T* const ordered = reinterpret_cast<T*>(spare.data());
  ForSpans(executor, n, span,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        ordered[i] = order[i] != NoVertex ? values[order[i]] : T{};
      }
    });
  if constexpr (isSwapped)
  {
    values.swap(spare);
  }
  else
  {
    values.assign(ordered, ordered + n);
  }
}

/**
 * Join what add(v, part) makes of `first` from the vertices of each span, also from those that are
 * not alive. The spans are joined in their order: the same for any executor.
 */
template <typename T, typename Add, typename Join>
T JoinVertices(
  const SurfaceMesh& mesh, Executor& executor, const T& first, const Add& add, const Join& join)
{
  constexpr std::size_t size = 2048;
  const std::size_t n = mesh.Rings.size();
  std::vector<T> parts((n + size - 1) / size, first);
  ForSpans(executor, n, size,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      T part = first;
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        add(v, part);
      }
      parts[span] = part;
    });
  return std::accumulate(parts.begin(), parts.end(), first, join);
}

/** The alive vertices along a Z-order (Morton) curve with cells of side `cell`, those of one by
 * index. */
std::vector<int> SpaceFillingOrder(
  const SurfaceMesh& mesh, double cell, Executor& executor = OnThisThread());
}

#endif
