// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankTestTools_h
#define volumicRankTestTools_h

#include "Core/Common/PieceOfSurface.h"
#include "Core/Surface/RankPiece.h"
#include "Core/Surface/SurfaceComponents.h"
#include "Core/Surface/SurfaceState.h"
#include "TestPrelude.h"

#include <map>

namespace volumic
{
/** Which rank a vertex of a whole surface belongs to, given how many ranks there are. */
using OwnerOf = std::function<int(int v, int ranks)>;

/** Of a surface that one rank has all of. */
inline SurfaceComponents OfAll()
{
  return SurfaceComponents({ OnThisRank(), [](int) { return true; } });
}

/** Ranks own cubes of space here and there, so that parts of one rank lie apart. */
inline OwnerOf ByCubes(const SurfaceState& whole, float side)
{
  return [&whole, side](int v, int ranks)
  {
    const Vector& p = whole.Mesh.Position[v];
    const auto along = [side](float x) { return static_cast<int>(std::floor(x / side)); };
    const int sum = along(p.X) + 2 * along(p.Y) + 3 * along(p.Z);
    return (sum % ranks + ranks) % ranks;
  };
}

/** Vertices next to each other are of different ranks, as a rule. */
inline OwnerOf ByTurns()
{
  return [](int v, int ranks) { return v % ranks; };
}

/** All of one rank. */
inline OwnerOf AllOf(int rank)
{
  return [rank](int, int ranks) { return rank % ranks; };
}

/**
 * Leaves a rank its own vertices, and those no farther from them than the halo; nobody may look at
 * where the others are.
 */
inline void TakePart(SurfaceState& part, const SurfaceState& whole, const OwnerOf& ownerOf,
  const Communicator& ranks, float halo, const Vector& low, const Vector& high)
{
  const auto isOwn = [&](int v) { return ownerOf(v, ranks.NumberOfRanks()) == ranks.Rank(); };
  const SurfaceMesh& mesh = whole.Mesh;
  part.Mesh.Position = mesh.Position;
  part.Mesh.Rings = mesh.Rings;
  std::vector<char> isThere(mesh.Rings.size(), 0);
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (mesh.IsAlive(v) && isOwn(v))
    {
      isThere[v] = 1;
      whole.Grid.Visit(mesh.Position[v], halo,
        [&](int w)
        {
          isThere[w] |= SquaredDistance(mesh.Position[v], mesh.Position[w]) <= halo * halo;
        });
    }
  }
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (!isThere[v])
    {
      part.Mesh.Position[v] = Vector(none, none, none);
      part.Mesh.Rings[v].Count = 0;
    }
  }
  part.Sizing = whole.Sizing;
  part.Reset(low, high);
  part.EulerCharacteristic = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (isThere[v])
    {
      part.FieldValue[v] = whole.FieldValue[v];
      part.Normal[v] = whole.Normal[v];
      part.EdgeLengthSum[v] = whole.EdgeLengthSum[v];
    }
  }
}

/** The piece that a rank is to have of a whole surface. */
inline PieceOfSurface Cut(
  const IndexedSurface& whole, int rank, int ranks, IndexedSurface& surface)
{
  const auto first = [&](int piece)
  { return static_cast<int>(static_cast<long long>(whole.Triangles.size()) * piece / ranks); };
  std::vector<std::vector<int>> piecesOf(whole.Points.size());
  for (int piece = 0; piece < ranks; ++piece)
  {
    for (int t = first(piece); t < first(piece + 1); ++t)
    {
      for (const int corner : whole.Triangles[t])
      {
        piecesOf[corner].push_back(piece);
      }
    }
  }
  PieceOfSurface cut;
  cut.FirstTriangle = first(rank);
  std::map<int, int> placeOf;
  for (std::size_t p = 0; p < piecesOf.size(); ++p)
  {
    const std::vector<int>& of = piecesOf[p];
    if (std::count(of.begin(), of.end(), rank) > 0)
    {
      placeOf[static_cast<int>(p)] = static_cast<int>(cut.Ids.size());
      cut.Ids.push_back(static_cast<int>(p));
      cut.Roles.push_back((of.front() == rank ? PieceOfSurface::IsCounted : 0) |
        (of.front() != of.back() ? PieceOfSurface::IsShared : 0));
      surface.Points.push_back(whole.Points[p]);
    }
  }
  for (int t = first(rank); t < first(rank + 1); ++t)
  {
    const Triangle& corners = whole.Triangles[t];
    surface.Triangles.push_back(
      { placeOf.at(corners[0]), placeOf.at(corners[1]), placeOf.at(corners[2]) });
  }
  return cut;
}

inline RankPiece PartOf(Communicator& ranks, const OwnerOf& ownerOf)
{
  const int count = ranks.NumberOfRanks();
  const int own = ranks.Rank();
  return { ranks, [ownerOf, count, own](int v) { return ownerOf(v, count) == own; } };
}
}

#endif
