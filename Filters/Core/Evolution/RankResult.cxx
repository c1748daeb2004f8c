// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A surface of several ranks as it is handed out: numbered as one rank would number it, then dealt
// out anew in pieces that follow each other in these numbers. One piece is the whole, at rank 0.
// Else no rank learns of more than its own vertices, those about them, and its piece.

#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/RankNumbers.h"
#include "Core/Surface/RemainingContacts.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** What a piece is told of one of its points. */
struct PointRecord
{
  int Id = 0;
  std::array<float, 3> Position{};
  std::array<float, 3> Normal{};
  float Residual = 0.f;
  std::uint8_t Motionless = 0;
  std::uint8_t Held = 0;
  std::uint8_t Role = 0;
  std::uint8_t None = 0; // No byte that is sent is left as it was.
};

/** And of one of its triangles: its number, and those of its corners. */
struct TriangleRecord
{
  int Id;
  Triangle Corners;
};

/** A vertex of this rank that is a point of a piece. */
struct Told
{
  int Vertex;
  std::uint8_t Role; ///< See PieceOfSurface.
};

/** Which piece has a triangle, and which points a piece has. */
class Dealing
{
public:
  Dealing(int pieces, int faces) : Pieces(pieces), Faces(faces) {}

  int FirstOf(int piece) const
  {
    return static_cast<int>(static_cast<std::int64_t>(this->Faces) * piece / this->Pieces);
  }
  int PieceOf(int face) const
  {
    return static_cast<int>(
      ((static_cast<std::int64_t>(face) + 1) * this->Pieces - 1) / this->Faces);
  }
  /** @return by piece those of some vertices that it has, in order */
  std::vector<std::vector<Told>> Deal(
    const SurfaceMesh& mesh, const VertexNumbers& numbers, const std::vector<int>& vertices) const;

private:
  /** Those with faces of a vertex, in order. */
  void FindPieces(
    const SurfaceMesh& mesh, const VertexNumbers& numbers, int v, std::vector<int>& found) const;

  int Pieces;
  int Faces;
};

void Dealing::FindPieces(
  const SurfaceMesh& mesh, const VertexNumbers& numbers, int v, std::vector<int>& found) const
{
  found.clear();
  const auto ofSmallest = [&](int smallest)
  {
    int face = numbers.Of[smallest].Face;
    mesh.VisitFaces(static_cast<std::size_t>(smallest), static_cast<std::size_t>(smallest) + 1,
      [&](int a, int b, int c)
      {
        if (a == v || b == v || c == v)
        {
          found.push_back(this->PieceOf(face));
        }
        ++face;
      });
  };
  ofSmallest(v);
  const Ring& ring = mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    if (ring.Item[i] < v)
    {
      ofSmallest(ring.Item[i]);
    }
  }
  SortUnique(found);
}

std::vector<std::vector<Told>> Dealing::Deal(
  const SurfaceMesh& mesh, const VertexNumbers& numbers, const std::vector<int>& vertices) const
{
  std::vector<std::vector<Told>> told(static_cast<std::size_t>(this->Pieces));
  std::vector<int> found;
  for (const int v : vertices)
  {
    this->FindPieces(mesh, numbers, v, found);
    for (const int piece : found)
    {
      const int role = (piece == found.front() ? PieceOfSurface::IsCounted : 0) |
        (found.size() > 1 ? PieceOfSurface::IsShared : 0);
      told[piece].push_back({ v, static_cast<std::uint8_t>(role) });
    }
  }
  return told;
}

/** The place of each of some numbers among them. */
class PlacesOf
{
public:
  PlacesOf(const std::vector<std::vector<int>>& ids, int end)
  {
    const std::size_t words = static_cast<std::size_t>(end) / WordSize + 1;
    MakeZeroed(this->Words, words);
    for (const std::vector<int>& ofRank : ids)
    {
      for (const int id : ofRank)
      {
        const auto i = static_cast<std::size_t>(id);
        this->Words[i / WordSize].Bits[i % WordSize] = true;
      }
    }
    for (Word& word : this->Words)
    {
      if (word.Bits.any()) // Others take no memory.
      {
        word.Before = this->Number;
        this->Number += static_cast<int>(word.Bits.count());
      }
    }
  }

  int Count() const { return this->Number; }
  int At(int id) const
  {
    const auto i = static_cast<std::size_t>(id);
    const Word& word = this->Words[i / WordSize];
    return word.Before + static_cast<int>((word.Bits << (WordSize - i % WordSize)).count());
  }

private:
  static constexpr std::size_t WordSize = 64;
  struct Word
  {
    std::bitset<WordSize> Bits;
    int Before;
  };
  LargeVector<Word> Words;
  int Number = 0;
};

/** Fills the piece of a rank. */
class PieceResult
{
public:
  PieceResult(SurfaceResult& result, const std::vector<std::vector<int>>& ids, int points,
    int firstFace, int faces)
    : Result(result), Places(ids, points)
  {
    const auto n = static_cast<std::size_t>(this->Places.Count());
    result.Points.resize(n);
    result.Normals.resize(n);
    result.Residual.resize(n);
    result.Motionless.resize(n);
    result.Held.resize(n);
    result.Piece.Ids.resize(n);
    result.Piece.Roles.resize(n);
    result.Triangles.resize(static_cast<std::size_t>(faces));
    result.Piece.FirstTriangle = firstFace;
  }

  void Take(const PointRecord& point)
  {
    const int p = this->Places.At(point.Id);
    this->Result.Points[p] = { point.Position[0], point.Position[1], point.Position[2] };
    this->Result.Normals[p] = point.Normal;
    this->Result.Residual[p] = point.Residual;
    this->Result.Motionless[p] = point.Motionless;
    this->Result.Held[p] = point.Held;
    this->Result.Piece.Ids[p] = point.Id;
    this->Result.Piece.Roles[p] = point.Role;
  }

  void Take(const TriangleRecord& triangle)
  {
    const Triangle& t = triangle.Corners;
    this->Result.Triangles[triangle.Id - this->Result.Piece.FirstTriangle] = {
      this->Places.At(t[0]), this->Places.At(t[1]), this->Places.At(t[2]) };
  }

private:
  SurfaceResult& Result;
  PlacesOf Places;
};

/** Vertices whose numbers are wanted beside those of the own ones. */
std::vector<int> OthersOf(const SurfaceMesh& mesh, const std::vector<int>& own,
  const RemainingContacts& contacts, const RankBlocks& blocks)
{
  std::vector<int> others;
  const auto add = [&](int w)
  {
    if (!blocks.IsOwnVertex(w))
    {
      others.push_back(w);
    }
  };
  for (const int v : own)
  {
    const Ring& ring = mesh.Rings[v];
    std::for_each(ring.Item, ring.Item + ring.Count, add);
  }
  for (const std::array<int, 2>& pair : contacts.Pairs)
  {
    add(pair[1]);
  }
  SortUnique(others);
  return others;
}

std::vector<std::vector<int>> IdsOf(
  const std::vector<std::vector<Told>>& told, const VertexNumbers& numbers)
{
  std::vector<std::vector<int>> ids;
  for (const std::vector<Told>& toRank : told)
  {
    ids.emplace_back();
    for (const Told& point : toRank)
    {
      ids.back().push_back(numbers.Of[point.Vertex].Point);
    }
  }
  return ids;
}

/** Those of all ranks, on all of them, in the order of one: few vertices are in contact. */
LargeVector<std::array<int, 2>> GatherPairs(
  Communicator& ranks, const RemainingContacts& contacts, const VertexNumbers& numbers)
{
  std::vector<std::array<int, 2>> pairs;
  for (const std::array<int, 2>& pair : contacts.Pairs)
  {
    pairs.push_back({ numbers.Of[pair[0]].Point, numbers.Of[pair[1]].Point });
  }
  pairs = GatherListsOnAll(ranks, pairs);
  std::sort(pairs.begin(), pairs.end());
  return { pairs.begin(), pairs.end() };
}
}

SurfaceResult SurfaceEvolution::Implementation::ResultOnRanks(int pieces) const
{
  const SurfaceState& s = this->State;
  Communicator& ranks = *this->Ranks;
  const int count = ranks.NumberOfRanks();
  const int rank = ranks.Rank();
  const RemainingContacts contacts = FindRemainingContacts(
    s, *this->TheField, this->Threads, [this](int v) { return this->Piece->IsOwnVertex(v); });
  const std::vector<int> own = this->OwnVertices();
  const VertexNumbers numbers =
    NumberOnRanks(ranks, s.Mesh, own, OthersOf(s.Mesh, own, contacts, *this->Piece));
  const Dealing dealing(pieces, numbers.All.Face);

  std::vector<std::vector<Told>> told = dealing.Deal(s.Mesh, numbers, own);
  told.resize(static_cast<std::size_t>(count)); // Other ranks get nothing.
  SurfaceResult result;
  result.Delta = s.Sizing.OfLevel();
  const int first = rank < pieces ? dealing.FirstOf(rank) : numbers.All.Face;
  const int end = rank < pieces ? dealing.FirstOf(rank + 1) : numbers.All.Face;
  PieceResult piece(result, ExchangeLists(ranks, IdsOf(told, numbers)), numbers.All.Point, first,
    end - first);

  const float sign = this->Options.ObjectIsBright ? 1.f : -1.f;
  const auto recordOf = [&](const Told& point)
  {
    const int v = point.Vertex;
    const Vector& place = s.Mesh.Position[v];
    const NormalCone& normal = s.Normal[v];
    return PointRecord{ numbers.Of[v].Point, { place.X, place.Y, place.Z },
      { normal.X, normal.Y, normal.Z }, sign * this->TheField->ValueAt(place), !s.Active[v],
      contacts.Held[v], point.Role };
  };
  // In turns, to one rank each time: all messages together are as much as the surface.
  for (int turn = 0; turn < count; ++turn)
  {
    const int to = (rank + turn) % count;
    const int from = (rank + count - turn) % count;
    std::vector<PointRecord> points;
    std::vector<TriangleRecord> triangles;
    for (const Told& point : std::exchange(told[to], {}))
    {
      points.push_back(recordOf(point));
      const auto v = static_cast<std::size_t>(point.Vertex);
      int face = numbers.Of[v].Face;
      s.Mesh.VisitFaces(v, v + 1,
        [&](int a, int b, int c)
        {
          if (dealing.PieceOf(face) == to)
          {
            triangles.push_back(
              { face, { numbers.Of[a].Point, numbers.Of[b].Point, numbers.Of[c].Point } });
          }
          ++face;
        });
    }
    MessageWriter writer;
    writer.AddArray(std::exchange(points, {}));
    writer.AddArray(std::exchange(triangles, {}));
    const Message message = Trade(ranks, to, from, writer.Take());
    MessageReader reader(message);
    reader.TakeArray(points);
    std::for_each(points.begin(), points.end(), [&piece](const auto& p) { piece.Take(p); });
    reader.TakeArray(triangles);
    std::for_each(triangles.begin(), triangles.end(), [&piece](const auto& t) { piece.Take(t); });
  }

  result.Contacts = GatherPairs(ranks, contacts, numbers);
  if (pieces > 1)
  {
    result.Piece.Ranks = &ranks;
  }
  else
  {
    result.Piece = PieceOfSurface();
  }
  return result;
}
}
