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
/** Points that a rank tells another one of at a time. */
constexpr std::size_t PointsAtOnce = 8192;

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

  /** What PieceSender has written. */
  void Take(const Message& message)
  {
    MessageReader reader(message);
    for (const PointRecord& point : reader.TakeVector<PointRecord>())
    {
      this->Take(point);
    }
    for (const TriangleRecord& triangle : reader.TakeVector<TriangleRecord>())
    {
      this->Take(triangle);
    }
  }

private:
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

  SurfaceResult& Result;
  PlacesOf Places;
};

/** Tells other ranks of their pieces. */
struct PieceSender
{
  const SurfaceState& State;
  const volumic::Field& Field;
  const float Sign; ///< Of the residuals.
  const RemainingContacts& Contacts;
  const VertexNumbers& Numbers;
  const Dealing& Dealt;

  Message Write(int piece, const std::vector<Told>& told, std::size_t begin, std::size_t end) const;

private:
  PointRecord RecordOf(const Told& point) const;
};

PointRecord PieceSender::RecordOf(const Told& point) const
{
  const int v = point.Vertex;
  const Vector& place = this->State.Mesh.Position[v];
  const NormalCone& normal = this->State.Normal[v];
  return { this->Numbers.Of[v].Point, { place.X, place.Y, place.Z },
    { normal.X, normal.Y, normal.Z }, this->Sign * this->Field.ValueAt(place),
    !this->State.Active[v], this->Contacts.Held[v], point.Role };
}

Message PieceSender::Write(
  int piece, const std::vector<Told>& told, std::size_t begin, std::size_t end) const
{
  std::vector<PointRecord> points;
  std::vector<TriangleRecord> triangles;
  for (std::size_t i = begin; i < std::min(end, told.size()); ++i)
  {
    points.push_back(this->RecordOf(told[i]));
    const auto v = static_cast<std::size_t>(told[i].Vertex);
    int face = this->Numbers.Of[v].Face;
    this->State.Mesh.VisitFaces(v, v + 1,
      [&](int a, int b, int c)
      {
        if (this->Dealt.PieceOf(face) == piece)
        {
          triangles.push_back({ face,
            { this->Numbers.Of[a].Point, this->Numbers.Of[b].Point, this->Numbers.Of[c].Point } });
        }
        ++face;
      });
  }
  MessageWriter writer;
  writer.AddArray(points);
  writer.AddArray(triangles);
  return writer.Take();
}

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
  std::vector<int> own = this->OwnVertices();
  const VertexNumbers numbers =
    NumberOnRanks(ranks, s.Mesh.Rings.size(), FacesOf(s.Mesh), own, OthersOf(s.Mesh, own, contacts, *this->Piece));
  const Dealing dealing(pieces, numbers.All.Face);
  std::vector<std::vector<Told>> told = dealing.Deal(s.Mesh, numbers, own);
  told.resize(static_cast<std::size_t>(count)); // Other ranks get nothing.
  std::vector<int>().swap(own);

  SurfaceResult result;
  result.Delta = s.Sizing.OfLevel();
  result.Contacts = GatherPairs(ranks, contacts, numbers);
  const int first = rank < pieces ? dealing.FirstOf(rank) : numbers.All.Face;
  const int end = rank < pieces ? dealing.FirstOf(rank + 1) : numbers.All.Face;
  PieceResult piece(result, ExchangeLists(ranks, IdsOf(told, numbers)), numbers.All.Point, first,
    end - first);
  const PieceSender sender{ s, *this->TheField, this->Options.ObjectIsBright ? 1.f : -1.f,
    contacts, numbers, dealing };
  // Little by little, to one rank at a time: all messages together are as much as the surface.
  std::size_t most = 0;
  for (const std::vector<Told>& toRank : told)
  {
    most = std::max(most, toRank.size());
  }
  const std::vector<std::size_t> ofRanks = GatherValues(ranks, most);
  most = *std::max_element(ofRanks.begin(), ofRanks.end());
  for (std::size_t begin = 0; begin < most; begin += PointsAtOnce)
  {
    for (int turn = 0; turn < count; ++turn)
    {
      const int to = (rank + turn) % count;
      const int from = (rank + count - turn) % count;
      piece.Take(
        Trade(ranks, to, from, sender.Write(to, told[to], begin, begin + PointsAtOnce)));
    }
  }
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
