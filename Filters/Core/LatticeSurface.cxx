// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeSurface.h"

#include "ObliqueRotation.h"
#include "RowCrossing.h"
#include "SurfaceState.h"
#include "TriangleTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
using Place = std::array<std::int64_t, 3>;
using Key = std::uint64_t;

/** A point of the lattice: of the corners of the cubes (0) or of their centres (1). */
struct LatticePoint
{
  int Kind;
  Place At;
};

class Lattice
{
public:
  Lattice(const IndexedSurface& surface, double pitch);

  std::int64_t NumberOfLayers() const { return this->Size[2]; }
  /** Finds which points of a layer the surface encloses; layers must come in order. */
  void Fill(std::int64_t k);
  /** Cuts the tetrahedra about the points of a layer; the next one must be filled. */
  void Cut(std::int64_t k);
  IndexedSurface Finish(Executor& executor);

private:
  struct Crossing
  {
    std::int64_t Row; ///< Of all rows of points of its kind.
    RowCrossing Where;
  };
  /** Layers of bits that are kept: those before and after the one that is cut, and itself. */
  static constexpr std::int64_t Kept = 3;
  /** An edge of the lattice with ends on either side. */
  struct CutEdge
  {
    int Ends[2]; ///< Places in Asked.
  };

  std::int64_t Index(const LatticePoint& p) const
  {
    return ((p.Kind * this->Size[2] + p.At[2]) * this->Size[1] + p.At[1]) * this->Size[0] +
      p.At[0];
  }
  double Coordinate(int kind, int axis, std::int64_t i) const
  {
    return this->Origin[axis] + this->Pitch * (static_cast<double>(i) + 0.5 * kind);
  }
  std::size_t PlaceOfWord(int kind, std::int64_t j, std::int64_t k, std::int64_t w) const
  {
    return static_cast<std::size_t>(
      ((kind * Kept + k % Kept) * this->Size[1] + j) * this->Words + w);
  }
  std::uint64_t Word(int kind, std::int64_t j, std::int64_t k, std::int64_t w) const
  {
    return this->Bits[this->PlaceOfWord(kind, j, k, w)];
  }
  bool IsInside(const LatticePoint& p) const
  {
    return this->Word(p.Kind, p.At[1], p.At[2], p.At[0] / 64) >> (p.At[0] % 64) & 1u;
  }
  void FindCrossings(int kind);
  bool IsUniform(std::int64_t w, std::int64_t j, std::int64_t k) const;
  void CutAbout(const Place& at);
  void CutTetrahedron(const LatticePoint (&corner)[4], unsigned inside);
  int CornerOn(const LatticePoint& p, const LatticePoint& q);
  int Ask(const LatticePoint& p);

  const IndexedSurface& Surface;
  double Pitch;
  Point Origin;
  Place Size;
  std::int64_t Words; ///< Of a row of bits.
  std::vector<std::uint64_t> Bits;
  std::vector<Crossing> Crossings[2]; ///< Of the two kinds of points, row by row.
  std::size_t Next[2] = { 0, 0 };     ///< The first of them in the layer to be filled.
  std::vector<Triangle> Triangles;
  std::vector<CutEdge> Edges; ///< One per corner of the result.
  std::vector<LatticePoint> Asked; ///< Whose distance from the surface is needed.
  std::unordered_map<Key, int> EdgeOf;
  std::unordered_map<std::int64_t, int> AskedOf;
};

Lattice::Lattice(const IndexedSurface& surface, double pitch)
  : Surface(surface)
  , Pitch(pitch)
{
  // Points set off by odd fractions, so that rows hit no corner of a surface on round numbers.
  const double aside[3] = { 0.4142135623, 0.3819660113, 0.2360679775 };
  constexpr double most = std::numeric_limits<double>::max();
  for (int k = 0; k < 3; ++k)
  {
    double low = most;
    double high = -most;
    for (const Triangle& t : surface.Triangles)
    {
      for (int corner : t)
      {
        low = std::min(low, surface.Points[corner][k]);
        high = std::max(high, surface.Points[corner][k]);
      }
    }
    this->Origin[k] = low - (1. + aside[k]) * pitch;
    this->Size[k] = static_cast<std::int64_t>(std::ceil((high - this->Origin[k]) / pitch)) + 2;
  }
  this->Words = (this->Size[0] + 63) / 64;
  this->Bits.assign(
    static_cast<std::size_t>(2 * Kept * this->Size[1] * this->Words), 0);
  this->FindCrossings(0);
  this->FindCrossings(1);
  // There is about one crossing per squared pitch of the surface, and six or seven cut edges.
  const std::size_t crossings = this->Crossings[0].size() + this->Crossings[1].size();
  this->EdgeOf.reserve(7 * crossings);
  this->AskedOf.reserve(5 * crossings);
}

void Lattice::FindCrossings(int kind)
{
  std::vector<Crossing>& crossings = this->Crossings[kind];
  const auto first = [&](int axis, double from)
  {
    const double place = (from - this->Coordinate(kind, axis, 0)) / this->Pitch;
    return std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(place - 1e-6)), 0);
  };
  for (const Triangle& t : this->Surface.Triangles)
  {
    const Point* p[3];
    for (int c = 0; c < 3; ++c)
    {
      p[c] = &this->Surface.Points[t[c]];
    }
    const double top = std::max({ (*p[0])[2], (*p[1])[2], (*p[2])[2] });
    const double bottom = std::min({ (*p[0])[2], (*p[1])[2], (*p[2])[2] });
    for (std::int64_t k = first(2, bottom); k < this->Size[2]; ++k)
    {
      const double z = this->Coordinate(kind, 2, k);
      if (z > top + 1e-6 * this->Pitch)
      {
        break;
      }
      // Where the plane at z passes the triangle, with a little room for rounding.
      double low = std::numeric_limits<double>::max();
      double high = -low;
      for (int c = 0; c < 3; ++c)
      {
        const Point& a = *p[c];
        const Point& b = *p[(c + 1) % 3];
        const double share = a[2] != b[2] ? std::clamp((z - a[2]) / (b[2] - a[2]), 0., 1.) : 0.;
        if ((a[2] - z) * (b[2] - z) <= 0. || share == 0. || share == 1.)
        {
          low = std::min(low, a[1] + share * (b[1] - a[1]));
          high = std::max(high, a[1] + share * (b[1] - a[1]));
        }
      }
      for (std::int64_t j = first(1, low); j < this->Size[1]; ++j)
      {
        const double y = this->Coordinate(kind, 1, j);
        if (y > high + 1e-6 * this->Pitch)
        {
          break;
        }
        const RowCrossing where = RowCrossing::Of(this->Surface, t, y, z);
        if (where.Turn != 0)
        {
          crossings.push_back({ k * this->Size[1] + j, where });
        }
      }
    }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b)
    { return a.Row != b.Row ? a.Row < b.Row : a.Where.X < b.Where.X; });
}

void Lattice::Fill(std::int64_t k)
{
  for (int kind : { 0, 1 })
  {
    const auto begin = static_cast<std::ptrdiff_t>(this->PlaceOfWord(kind, 0, k, 0));
    std::fill_n(this->Bits.begin() + begin, this->Size[1] * this->Words, std::uint64_t(0));
    const std::vector<Crossing>& crossings = this->Crossings[kind];
    const double start = this->Coordinate(kind, 0, 0);
    int around = 0;
    for (std::size_t& n = this->Next[kind];
         n < crossings.size() && crossings[n].Row < (k + 1) * this->Size[1]; ++n)
    {
      around += crossings[n].Where.Turn;
      if (n + 1 == crossings.size() || crossings[n + 1].Row != crossings[n].Row)
      {
        around = 0;
        continue;
      }
      if (around < 1)
      {
        continue;
      }
      const auto from =
        static_cast<std::int64_t>(std::ceil((crossings[n].Where.X - start) / this->Pitch));
      const auto to =
        static_cast<std::int64_t>(std::ceil((crossings[n + 1].Where.X - start) / this->Pitch));
      for (std::int64_t i = from; i < to; ++i)
      {
        const std::int64_t j = crossings[n].Row - k * this->Size[1];
        this->Bits[this->PlaceOfWord(kind, j, k, i / 64)] |= std::uint64_t(1) << (i % 64);
      }
    }
  }
}

bool Lattice::IsUniform(std::int64_t w, std::int64_t j, std::int64_t k) const
{
  // Of the 64 points of a word, and of all that their tetrahedra reach.
  const std::uint64_t value = this->Word(0, j, k, w);
  if (value != 0 && value != ~std::uint64_t(0))
  {
    return false;
  }
  for (std::int64_t x = std::max<std::int64_t>(w - 1, 0); x <= std::min(w + 1, this->Words - 1);
       ++x)
  {
    for (const auto& row : { std::array<std::int64_t, 3>{ 0, j, k }, { 0, j + 1, k },
           { 0, j, k + 1 }, { 1, j, k }, { 1, j - 1, k }, { 1, j, k - 1 }, { 1, j - 1, k - 1 } })
    {
      if (this->Word(static_cast<int>(row[0]), row[1], row[2], x) != value)
      {
        return false;
      }
    }
  }
  return true;
}

void Lattice::Cut(std::int64_t k)
{
  if (k < 1)
  {
    return; // All is outside there.
  }
  for (std::int64_t j = 1; j + 1 < this->Size[1]; ++j)
  {
    for (std::int64_t w = 0; w < this->Words; ++w)
    {
      if (this->IsUniform(w, j, k))
      {
        continue;
      }
      const std::int64_t end = std::min(64 * (w + 1), this->Size[0] - 1);
      for (std::int64_t i = std::max<std::int64_t>(64 * w, 1); i < end; ++i)
      {
        this->CutAbout({ i, j, k });
      }
    }
  }
}

void Lattice::CutAbout(const Place& at)
{
  // Each tetrahedron has one edge between corners of cubes, and one between centres: it belongs to
  // the lower end of the former.
  const LatticePoint own{ 0, at };
  for (int axis = 0; axis < 3; ++axis)
  {
    LatticePoint next = own;
    ++next.At[axis];
    LatticePoint about[4];
    const int first = (axis + 1) % 3;
    const int second = (axis + 2) % 3;
    for (int turn = 0; turn < 4; ++turn)
    {
      about[turn] = { 1, at };
      about[turn].At[first] -= turn == 0 || turn == 3;
      about[turn].At[second] -= turn == 0 || turn == 1;
    }
    const unsigned ends =
      static_cast<unsigned>(this->IsInside(own)) | static_cast<unsigned>(this->IsInside(next)) << 1;
    bool inside[4];
    for (int turn = 0; turn < 4; ++turn)
    {
      inside[turn] = this->IsInside(about[turn]);
    }
    for (int turn = 0; turn < 4; ++turn)
    {
      const int after = (turn + 1) % 4;
      const unsigned bits = ends | static_cast<unsigned>(inside[turn]) << 2 |
        static_cast<unsigned>(inside[after]) << 3;
      if (bits != 0 && bits != 15)
      {
        this->CutTetrahedron({ own, next, about[turn], about[after] }, bits);
      }
    }
  }
}

void Lattice::CutTetrahedron(const LatticePoint (&corner)[4], unsigned inside)
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

int Lattice::CornerOn(const LatticePoint& p, const LatticePoint& q)
{
  // An edge is known by its lower end, or the one at a corner of cubes, and its direction.
  const bool swapped = p.Kind != q.Kind ? p.Kind == 1 : p.At > q.At;
  const LatticePoint& from = swapped ? q : p;
  const LatticePoint& to = swapped ? p : q;
  Key direction = from.Kind == to.Kind ? 0 : 3;
  for (int k = 0; k < 3; ++k)
  {
    const bool differs = from.At[k] != to.At[k];
    direction += static_cast<Key>(differs) * (from.Kind == to.Kind ? k : 1 << k);
  }
  const Key key = static_cast<Key>(this->Index(from)) * 16 + direction;
  const auto found = this->EdgeOf.emplace(key, static_cast<int>(this->Edges.size()));
  if (found.second)
  {
    this->Edges.push_back({ { this->Ask(from), this->Ask(to) } });
  }
  return found.first->second;
}

int Lattice::Ask(const LatticePoint& p)
{
  const auto found =
    this->AskedOf.emplace(this->Index(p), static_cast<int>(this->Asked.size()));
  if (found.second)
  {
    this->Asked.push_back(p);
  }
  return found.first->second;
}

IndexedSurface Lattice::Finish(Executor& executor)
{
  const TriangleTree tree(this->Surface);
  std::vector<double> distance(this->Asked.size());
  std::vector<Point> place(this->Asked.size());
  executor.For(this->Asked.size(), 256,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t n = begin; n < end; ++n)
      {
        for (int k = 0; k < 3; ++k)
        {
          place[n][k] = this->Coordinate(this->Asked[n].Kind, k, this->Asked[n].At[k]);
        }
        distance[n] = std::sqrt(tree.SquaredDistance(place[n]));
      }
    });
  // Not so near to the ends that triangles become slivers.
  constexpr double least = 0.15;
  IndexedSurface result;
  result.Points.reserve(this->Edges.size());
  for (const CutEdge& edge : this->Edges)
  {
    const int a = edge.Ends[0];
    const int b = edge.Ends[1];
    const double both = distance[a] + distance[b];
    const double share = std::clamp(both > 0. ? distance[a] / both : 0.5, least, 1. - least);
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
  IndexedSurface turned = surface;
  for (Point& p : turned.Points)
  {
    p = rotation.Apply(p);
  }
  Lattice lattice(turned, pitch);
  lattice.Fill(0);
  for (std::int64_t k = 0; k + 1 < lattice.NumberOfLayers(); ++k)
  {
    if (!goOn(0.8 * static_cast<double>(k) / static_cast<double>(lattice.NumberOfLayers())))
    {
      return {};
    }
    lattice.Fill(k + 1);
    lattice.Cut(k);
  }
  IndexedSurface result = lattice.Finish(executor);
  for (Point& p : result.Points)
  {
    p = rotation.Undo(p);
  }
  return goOn(1.) ? std::move(result) : IndexedSurface();
}
}
