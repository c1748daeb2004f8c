// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A surface in pieces as it is handed out: each rank finds what is to be said of its own vertices,
// rank 0 puts it together, in the order in which one rank would.

#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Surface/RemainingContacts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Of the own vertices of a rank, by index. */
struct ResultPiece
{
  std::vector<int> Vertices;
  std::vector<std::uint8_t> Faces; ///< How many have a vertex as their smallest one.
  std::vector<std::array<float, 3>> Places;
  std::vector<std::array<float, 3>> Normals;
  std::vector<float> Residual;
  std::vector<std::uint8_t> Motionless;
  std::vector<std::uint8_t> Held;
  std::vector<std::array<int, 3>> Triangles; ///< Of vertices, smallest first, in its order.
  std::vector<std::array<int, 2>> Contacts;

  /** What says how much there is, and what there is. */
  Message Sizes() const
  {
    MessageWriter writer;
    writer.AddArray(this->Vertices);
    writer.AddArray(this->Faces);
    return writer.Take();
  }
  Message Contents() const
  {
    MessageWriter writer;
    writer.AddArray(this->Places);
    writer.AddArray(this->Normals);
    writer.AddArray(this->Residual);
    writer.AddArray(this->Motionless);
    writer.AddArray(this->Held);
    writer.AddArray(this->Triangles);
    writer.AddArray(this->Contacts);
    return writer.Take();
  }
  void TakeSizes(const Message& message)
  {
    MessageReader reader(message);
    reader.TakeArray(this->Vertices);
    reader.TakeArray(this->Faces);
  }
  void TakeContents(const Message& message)
  {
    MessageReader reader(message);
    reader.TakeArray(this->Places);
    reader.TakeArray(this->Normals);
    reader.TakeArray(this->Residual);
    reader.TakeArray(this->Motionless);
    reader.TakeArray(this->Held);
    reader.TakeArray(this->Triangles);
    reader.TakeArray(this->Contacts);
  }
};

/** The whole that pieces are put into. */
class WholeResult
{
public:
  explicit WholeResult(std::size_t places)
    : Point(places, -1)
    , FirstFace(places, 0)
  {
  }

  void Count(const ResultPiece& piece)
  {
    for (std::size_t i = 0; i < piece.Vertices.size(); ++i)
    {
      this->Point[piece.Vertices[i]] = 0;
      this->FirstFace[piece.Vertices[i]] = piece.Faces[i];
    }
  }

  /** After all have been counted: in the order of the vertices. */
  void MakeRoom(SurfaceResult& result)
  {
    int points = 0;
    int faces = 0;
    for (std::size_t v = 0; v < this->Point.size(); ++v)
    {
      if (this->Point[v] == 0)
      {
        this->Point[v] = points++;
        faces += std::exchange(this->FirstFace[v], faces);
      }
    }
    const auto count = static_cast<std::size_t>(points);
    result.Points.resize(count);
    result.Normals.resize(count);
    result.Residual.resize(count);
    result.Motionless.resize(count);
    result.Held.resize(count);
    result.Triangles.resize(static_cast<std::size_t>(faces));
  }

  void Take(const ResultPiece& piece, SurfaceResult& result)
  {
    std::size_t face = 0;
    for (std::size_t i = 0; i < piece.Vertices.size(); ++i)
    {
      const int v = piece.Vertices[i];
      const int p = this->Point[v];
      result.Points[p] = { piece.Places[i][0], piece.Places[i][1], piece.Places[i][2] };
      result.Normals[p] = piece.Normals[i];
      result.Residual[p] = piece.Residual[i];
      result.Motionless[p] = piece.Motionless[i];
      result.Held[p] = piece.Held[i];
      for (int k = 0; k < piece.Faces[i]; ++k, ++face)
      {
        const std::array<int, 3>& t = piece.Triangles[face];
        result.Triangles[static_cast<std::size_t>(this->FirstFace[v] + k)] = { this->Point[t[0]],
          this->Point[t[1]], this->Point[t[2]] };
      }
    }
    for (const std::array<int, 2>& pair : piece.Contacts)
    {
      result.Contacts.push_back({ this->Point[pair[0]], this->Point[pair[1]] });
    }
  }

private:
  LargeVector<int> Point;     ///< By vertex; -1: there is none.
  LargeVector<int> FirstFace; ///< By vertex: at first how many.
};
}

SurfaceResult SurfaceEvolution::Implementation::ResultOnRanks() const
{
  const SurfaceState& s = this->State;
  ResultPiece own;
  own.Vertices = this->OwnVertices();
  const RemainingContacts contacts = FindRemainingContacts(
    s, *this->TheField, this->Threads, [this](int v) { return this->Piece->IsOwnVertex(v); });
  const float sign = this->Options.ObjectIsBright ? 1.f : -1.f;
  for (const int v : own.Vertices)
  {
    const Vector& place = s.Mesh.Position[v];
    const NormalCone& normal = s.Normal[v];
    own.Places.push_back({ place.X, place.Y, place.Z });
    own.Normals.push_back({ normal.X, normal.Y, normal.Z });
    own.Residual.push_back(sign * this->TheField->ValueAt(place));
    own.Motionless.push_back(!s.Active[v]);
    own.Held.push_back(contacts.Held[v]);
    const std::size_t faces = own.Triangles.size();
    s.Mesh.VisitFaces(static_cast<std::size_t>(v), static_cast<std::size_t>(v) + 1,
      [&own](int a, int b, int c) { own.Triangles.push_back({ a, b, c }); });
    own.Faces.push_back(static_cast<std::uint8_t>(own.Triangles.size() - faces));
  }
  own.Contacts.assign(contacts.Pairs.begin(), contacts.Pairs.end());

  SurfaceResult result;
  result.Delta = s.Sizing.OfLevel();
  const auto ranks = static_cast<std::size_t>(this->Ranks->NumberOfRanks());
  if (!this->IsFirstRank())
  {
    this->Ranks->Gather(own.Sizes());
    this->Ranks->Pass(this->Ranks->Rank(), 0, own.Contents());
    return result;
  }
  std::vector<ResultPiece> pieces(ranks);
  const std::vector<Message> sizes = this->Ranks->Gather(own.Sizes());
  pieces[0] = std::move(own);
  WholeResult whole(s.Mesh.Rings.size());
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    if (rank > 0)
    {
      pieces[rank].TakeSizes(sizes[rank]);
    }
    whole.Count(pieces[rank]);
  }
  whole.MakeRoom(result);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    // One after the other: all together are as much as the surface.
    if (rank > 0)
    {
      pieces[rank].TakeContents(this->Ranks->Pass(static_cast<int>(rank), 0));
    }
    whole.Take(std::exchange(pieces[rank], ResultPiece()), result);
  }
  std::sort(result.Contacts.begin(), result.Contacts.end());
  return result;
}
}
