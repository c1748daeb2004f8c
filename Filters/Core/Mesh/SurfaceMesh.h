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
/** Return the edges of a closed triangulated surface: E = 3 (V - chi), which may exceed int. */
constexpr std::int64_t NumberOfEdges(std::int64_t vertices, std::int64_t eulerCharacteristic)
{
  return 3 * (vertices - eulerCharacteristic);
}

/** Neighbours of a vertex, counter-clockwise from outside. A cache line limits the valence. */
struct alignas(64) Ring
{
  static constexpr int Capacity = 15;

  int Count = 0; ///< Valence; 0 marks a free slot.
  int Item[Capacity];

  /** Return the index of a neighbour in the ring, or -1. */
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
  /** Return the neighbour after `vertex`, which must be in the ring. */
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
 * Range of reserved vertex slots for edits that run while other threads edit other parts of the
 * mesh. It counts the vertices that these edits add and remove.
 */
struct VertexSlots
{
  int Next = 0;
  int End = 0;
  int Added = 0; ///< Added minus removed vertices.
  bool Has(int n) const { return this->End - this->Next >= n; }
};

/** Marks a free slot in an order of vertices. */
constexpr int NoVertex = -1;

/** Buffers for reordered vertex values. Arrays of other types use the buffer of the rings. */
template <typename T>
struct ReorderBuffer
{
  LargeVector<T> Values;
};
struct ReorderBuffers
  : ReorderBuffer<Ring>
  , ReorderBuffer<Vector>
  , ReorderBuffer<float>
  , ReorderBuffer<std::uint8_t>
{
};

/**
 * Closed oriented triangle mesh of one or more components.
 *
 * The rings alone are the connectivity: the faces are the triangles (v, ring[i], ring[i + 1]).
 * There are no face or edge records. Position and ring of a vertex lie in two cache lines. Indices
 * are stable, and those of removed vertices are not reused, until Reorder().
 */
class SurfaceMesh
{
public:
  LargeVector<Vector> Position;
  LargeVector<Ring> Rings;

  /** Return the number of slots, free ones included. */
  int Size() const { return static_cast<int>(this->Rings.size()); }
  /** Return the number of alive vertices, after Count() of all VertexSlots. */
  int NumberOfVertices() const { return this->Size() - this->FreeSlots; }
  bool IsAlive(int v) const { return this->Rings[v].Count > 0; }
  bool AreNeighbours(int u, int v) const { return this->Rings[u].Contains(v); }

  /** Return whether two different vertices are at least four edges apart or not connected. */
  bool AreFarApart(int v, int w) const;

  /**
   * Add a vertex. The caller must set its ring before any other call.
   * @param slots provides the index and must not be used up; null: the index follows the last one
   * @return index of the new vertex
   */
  int AddVertex(const Vector& position, VertexSlots* slots = nullptr);
  /** Remove a vertex. It is counted in `slots`, or in the mesh if that is null. */
  void RemoveVertex(int v, VertexSlots* slots = nullptr);
  /** Add the counts of reserved slots that are no longer in use. */
  void Count(const VertexSlots& slots) { this->FreeSlots -= slots.Added; }

  /** Call visit(a, b, c) once per face, counter-clockwise, with the smallest index first. */
  template <typename Visitor>
  void VisitFaces(Visitor&& visit) const
  {
    this->VisitFaces(0, this->Rings.size(), visit);
  }
  /** Visit the faces whose smallest index is in [begin, end). */
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
  std::size_t CountFaces(std::size_t begin, std::size_t end) const
  {
    std::size_t count = 0;
    this->VisitFaces(begin, end, [&count](int, int, int) { ++count; });
    return count;
  }

  std::int64_t NumberOfFaces(Executor& executor = OnThisThread()) const;
  /** Compute V - E + F. O(vertices). */
  int CountEulerCharacteristic(Executor& executor = OnThisThread()) const;

  /** Return all alive vertices, in the order of their indices, and their faces. */
  IndexedSurface ToIndexed(Executor& executor = OnThisThread()) const;

  /**
   * Append the components of a closed oriented manifold triangle mesh.
   * @return index of the first new vertex; the others follow in order
   * @throws std::invalid_argument if the surface is not closed, oriented and manifold, or if a
   *   vertex has more than Ring::Capacity neighbours
   */
  int Append(const IndexedSurface& surface, Executor& executor = OnThisThread());

  /**
   * Renumber the vertices: vertex i of the result is the old vertex order[i]. NoVertex makes a free
   * slot. Each alive vertex must occur once.
   * @param buffers reused between calls, as allocation takes longer than the copy
   */
  void Reorder(const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor);
  void Reorder(const std::vector<int>& order, Executor& executor = OnThisThread());

  void Clear();
  /** Make n vertices, whose positions and rings the caller sets. */
  void Allocate(std::size_t n);

private:
  int FreeSlots = 0;
};

/** Reorder vertex values, see SurfaceMesh::Reorder. The old values become the buffer. */
template <typename T>
void Reorder(LargeVector<T>& values, const std::vector<int>& order, ReorderBuffers& buffers,
  Executor& executor)
{
  constexpr bool isSwapped = std::is_base_of_v<ReorderBuffer<T>, ReorderBuffers>;
  using BufferType = std::conditional_t<isSwapped, T, Ring>;
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(BufferType));
  constexpr std::size_t span = 16384;
  const std::size_t n = order.size();
  LargeVector<BufferType>& buffer = static_cast<ReorderBuffer<BufferType>&>(buffers).Values;
  MakeRoom(buffer, n);
  buffer.resize(n);
  T* const ordered = reinterpret_cast<T*>(buffer.data());
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
    values.swap(buffer);
  }
  else
  {
    values.assign(ordered, ordered + n);
  }
}

/**
 * Return the join of the parts that add(v, part) makes of `first` for each span of slots, free ones
 * included. The spans are joined in order: the result does not depend on the executor.
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

/**
 * Return the alive vertices along a Z-order (Morton) curve with cells of side `cell`. Vertices of a
 * cell are sorted by index.
 */
std::vector<int> SpaceFillingOrder(
  const SurfaceMesh& mesh, double cell, Executor& executor = OnThisThread());
}

#endif
