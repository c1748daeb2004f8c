// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/LatticeSurface.h"

#include "Core/Mesh/LatticeInside.h"
#include "Core/Mesh/ObliqueRotation.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** About what a crossing of a row and the surface brings about: room is made for so many. */
constexpr std::size_t EdgesPerCrossing = 7;
constexpr std::size_t EndsPerCrossing = 5;
/**
 * Corners keep this share of their edge from its ends, so that triangles don't become slivers: no
 * edge of the result is shorter than a tenth of the pitch.
 */
constexpr double LeastShare = 0.15;
/** Ends of edges under which a chunk is not worth a thread. */
constexpr std::size_t EndGrain = 256;
/** Of the whole work, for the progress; the rest are the distances. */
constexpr double ShareOfCuts = 0.8;

/** Cuts the tetrahedra of a lattice where a surface passes them. */
class TetrahedraCutter
{
public:
  TetrahedraCutter(const IndexedSurface& surface, double pitch)
    : Surface(surface), Lattice(surface, pitch)
  {
    this->EdgeOf.reserve(EdgesPerCrossing * this->Lattice.NumberOfCrossings());
    this->EndOf.reserve(EndsPerCrossing * this->Lattice.NumberOfCrossings());
    this->Lattice.Fill(0);
  }

  /** Layers must be cut in order from 0 to one less than there are. */
  void Cut(std::int64_t k);
  std::int64_t NumberOfLayers() const { return this->Lattice.Size()[2]; }
  /** The surface that the cuts make. */
  IndexedSurface Finish(Executor& executor);

private:
  /** An edge of the lattice with ends on either side. */
  struct CutEdge
  {
    int From; ///< Of Ends.
    int To;
  };

  void CutAbout(const LatticePoint& own);
  void CutTetrahedron(const LatticePoint (&corner)[4], unsigned inside);
  int CornerOn(const LatticePoint& p, const LatticePoint& q);
  int EndAt(const LatticePoint& p);

  const IndexedSurface& Surface;
  LatticeInside Lattice;
  LargeVector<Triangle> Triangles;
  LargeVector<CutEdge> Edges;     ///< One per corner of the result.
  LargeVector<LatticePoint> Ends; ///< Of the edges: their distance from the surface is needed.
  std::unordered_map<std::uint64_t, int> EdgeOf; ///< By LatticeKey().
  std::unordered_map<std::uint64_t, int> EndOf;
};

void TetrahedraCutter::Cut(std::int64_t k)
{
  this->Lattice.Fill(k + 1);
  if (k < 1)
  {
    return; // All is outside there.
  }
  constexpr std::int64_t word = LatticeInside::WordSize;
  const std::array<std::int64_t, 3>& size = this->Lattice.Size();
  for (std::int64_t j = 1; j + 1 < size[1]; ++j)
  {
    for (std::int64_t w = 0; w < this->Lattice.WordsInRow(); ++w)
    {
      if (this->Lattice.IsUniform(w, j, k))
      {
        continue;
      }
      const std::int64_t end = std::min(word * (w + 1), size[0] - 1);
      for (std::int64_t i = std::max<std::int64_t>(word * w, 1); i < end; ++i)
      {
        this->CutAbout(
          { static_cast<int>(2 * i), static_cast<int>(2 * j), static_cast<int>(2 * k) });
      }
    }
  }
}

void TetrahedraCutter::CutAbout(const LatticePoint& own)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const LatticeEdge edge(own, axis);
    const unsigned ends = static_cast<unsigned>(this->Lattice.IsInside(edge.From)) |
      static_cast<unsigned>(this->Lattice.IsInside(edge.To)) << 1;
    bool inside[4];
    for (int turn = 0; turn < 4; ++turn)
    {
      inside[turn] = this->Lattice.IsInside(edge.About[turn]);
    }
    for (int turn = 0; turn < 4; ++turn)
    {
      const int after = (turn + 1) % 4;
      const unsigned bits =
        ends | static_cast<unsigned>(inside[turn]) << 2 | static_cast<unsigned>(inside[after]) << 3;
      if (bits != 0 && bits != 15)
      {
        this->CutTetrahedron({ edge.From, edge.To, edge.About[turn], edge.About[after] }, bits);
      }
    }
  }
}

void TetrahedraCutter::CutTetrahedron(const LatticePoint (&corner)[4], unsigned inside)
{
  // Even permutations, so that all tetrahedra are looked at with the same handedness: those with
  // each corner first, and those with each pair first.
  static constexpr int single[4][4] = { { 0, 1, 2, 3 }, { 1, 0, 3, 2 }, { 2, 3, 0, 1 },
    { 3, 2, 1, 0 } };
  static constexpr int pairs[6][4] = { { 0, 1, 2, 3 }, { 0, 2, 3, 1 }, { 0, 3, 1, 2 },
    { 1, 2, 0, 3 }, { 1, 3, 2, 0 }, { 2, 3, 0, 1 } };
  const auto has = [inside](int c) { return (inside >> c & 1u) != 0; };
  const int count = has(0) + has(1) + has(2) + has(3);
  if (count != 2)
  {
    const bool wanted = count == 1;
    int lone = 0;
    while (has(lone) != wanted)
    {
      ++lone;
    }
    const int* c = single[lone];
    Triangle t;
    for (int n = 0; n < 3; ++n)
    {
      t[n] = this->CornerOn(corner[c[0]], corner[c[n + 1]]);
    }
    if (!wanted)
    {
      std::swap(t[1], t[2]);
    }
    this->Triangles.push_back(t);
    return;
  }
  const int* c = *std::find_if(std::begin(pairs), std::end(pairs),
    [&has](const int(&pair)[4]) { return has(pair[0]) && has(pair[1]); });
  const int quad[4] = { this->CornerOn(corner[c[0]], corner[c[2]]),
    this->CornerOn(corner[c[0]], corner[c[3]]), this->CornerOn(corner[c[1]], corner[c[3]]),
    this->CornerOn(corner[c[1]], corner[c[2]]) };
  this->Triangles.push_back({ quad[0], quad[1], quad[2] });
  this->Triangles.push_back({ quad[2], quad[3], quad[0] });
}

int TetrahedraCutter::CornerOn(const LatticePoint& p, const LatticePoint& q)
{
  const auto found = this->EdgeOf.emplace(LatticeKey(p, q), static_cast<int>(this->Edges.size()));
  if (found.second)
  {
    // From the lower end, or the one at a corner of cubes.
    const bool isMixed = ((p[0] ^ q[0]) & 1) != 0;
    const bool isSwapped = isMixed ? (p[0] & 1) != 0 : p > q;
    const int first = this->EndAt(isSwapped ? q : p);
    this->Edges.push_back({ first, this->EndAt(isSwapped ? p : q) });
  }
  return found.first->second;
}

int TetrahedraCutter::EndAt(const LatticePoint& p)
{
  const auto found = this->EndOf.emplace(LatticeKey(p), static_cast<int>(this->Ends.size()));
  if (found.second)
  {
    this->Ends.push_back(p);
  }
  return found.first->second;
}

IndexedSurface TetrahedraCutter::Finish(Executor& executor)
{
  const TriangleTree tree(this->Surface);
  LargeVector<double> distance(this->Ends.size());
  LargeVector<Point> place(this->Ends.size());
  executor.For(this->Ends.size(), EndGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t n = begin; n < end; ++n)
      {
        place[n] = this->Lattice.PlaceOf(this->Ends[n]);
        distance[n] = std::sqrt(tree.SquaredDistance(place[n]));
      }
    });
  IndexedSurface result;
  result.Points.reserve(this->Edges.size());
  for (const CutEdge& edge : this->Edges)
  {
    const int a = edge.From;
    const int b = edge.To;
    const double both = distance[a] + distance[b];
    const double share =
      std::clamp(both > 0. ? distance[a] / both : 0.5, LeastShare, 1. - LeastShare);
    Point p;
    for (int k = 0; k < 3; ++k)
    {
      p[k] = place[a][k] + share * (place[b][k] - place[a][k]);
    }
    result.Points.push_back(p);
  }
  result.Triangles = std::move(this->Triangles);
  return result;
}
}

IndexedSurface RemeshOnLattice(const IndexedSurface& surface, double pitch, int attempt,
  Executor& executor, const std::function<bool(double share)>& goOn)
{
  const ObliqueRotation rotation(attempt);
  IndexedSurface rotated = surface;
  for (Point& p : rotated.Points)
  {
    p = rotation.Apply(p);
  }
  TetrahedraCutter cutter(rotated, pitch);
  for (std::int64_t k = 0; k + 1 < cutter.NumberOfLayers(); ++k)
  {
    if (!goOn(ShareOfCuts * static_cast<double>(k) / static_cast<double>(cutter.NumberOfLayers())))
    {
      return {};
    }
    cutter.Cut(k);
  }
  IndexedSurface result = cutter.Finish(executor);
  for (Point& p : result.Points)
  {
    p = rotation.Undo(p);
  }
  return goOn(1.) ? std::move(result) : IndexedSurface();
}
}
