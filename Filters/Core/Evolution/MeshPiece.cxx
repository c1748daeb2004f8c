// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MeshPiece.h"

#include "Core/Common/Box.h"
#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/RankNumbers.h"
#include "Core/Surface/SurfaceState.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 8192;
/** Of each rank, to tell how the vertices of all are spread along the curve. */
constexpr std::size_t Samples = 64;

/** The place of a vertex along the curve. */
struct CurvePlace
{
  std::uint64_t Code;
  std::int64_t Vertex; // As wide as the code: no byte that is sent is left as it was.

  friend bool operator<(const CurvePlace& a, const CurvePlace& b)
  {
    return a.Code != b.Code ? a.Code < b.Code : a.Vertex < b.Vertex;
  }
};

/** The corner of all ranks' vertices, where the curve begins. */
Vector LowestOfRanks(
  Communicator& ranks, const SurfaceMesh& mesh, const std::vector<int>& own)
{
  constexpr float most = std::numeric_limits<float>::max();
  Vector low(most, most, most);
  for (const int v : own)
  {
    low = Minimum(low, mesh.Position[v]);
  }
  for (const Vector& ofRank : GatherValues(ranks, low))
  {
    low = Minimum(low, ofRank);
  }
  return low;
}

/** Where the ranks' shares of the curve end: those of all but the last, about as long. */
std::vector<CurvePlace> FindEnds(Communicator& ranks, const std::vector<CurvePlace>& own)
{
  const auto count = static_cast<std::size_t>(ranks.NumberOfRanks());
  const std::size_t all = SumOfRanks(ranks, own.size());
  const std::size_t stride = std::max<std::size_t>(all / (count * Samples), 1);
  std::vector<CurvePlace> samples;
  for (std::size_t i = stride / 2; i < own.size(); i += stride)
  {
    samples.push_back(own[i]);
  }
  samples = GatherListsOnAll(ranks, samples);
  std::sort(samples.begin(), samples.end());
  std::vector<CurvePlace> ends;
  for (std::size_t rank = 1; rank < count && !samples.empty(); ++rank)
  {
    ends.push_back(samples[rank * samples.size() / count]);
  }
  return ends;
}

/** By rank, which of some places lie on its share. */
std::vector<std::vector<CurvePlace>> DealOut(const std::vector<CurvePlace>& places,
  const std::vector<CurvePlace>& ends, std::size_t ranks)
{
  std::vector<std::vector<CurvePlace>> ofRanks(ranks);
  for (const CurvePlace& place : places)
  {
    ofRanks[std::upper_bound(ends.begin(), ends.end(), place) - ends.begin()].push_back(place);
  }
  return ofRanks;
}

/** The numbers of vertices along the curve. */
class CurveNumbers
{
public:
  CurveNumbers(Communicator& ranks, std::vector<CurvePlace> own, Executor& executor)
    : Ranks(ranks)
  {
    SortInSpans(executor, own);
    this->Ends = FindEnds(ranks, own);
    const auto count = static_cast<std::size_t>(ranks.NumberOfRanks());
    for (const auto& ofRank : ExchangeLists(ranks, DealOut(own, this->Ends, count)))
    {
      this->Share.insert(this->Share.end(), ofRank.begin(), ofRank.end());
    }
    SortInSpans(executor, this->Share);
    const std::vector<std::size_t> sizes = GatherValues(ranks, this->Share.size());
    const auto first = sizes.begin();
    this->Before = std::accumulate(first, first + ranks.Rank(), std::size_t(0));
    this->All = std::accumulate(first, sizes.end(), std::size_t(0));
  }

  std::size_t NumberOfVertices() const { return this->All; }
  /** By all ranks: of some vertices, into an array that has a place for each. */
  void Find(const std::vector<CurvePlace>& wanted, LargeVector<int>& numbers) const
  {
    const auto count = static_cast<std::size_t>(this->Ranks.NumberOfRanks());
    const std::vector<std::vector<CurvePlace>> asked = DealOut(wanted, this->Ends, count);
    std::vector<std::vector<int>> answers;
    for (const std::vector<CurvePlace>& ofRank : ExchangeLists(this->Ranks, asked))
    {
      answers.emplace_back();
      for (const CurvePlace& place : ofRank)
      {
        const auto at = std::lower_bound(this->Share.begin(), this->Share.end(), place);
        answers.back().push_back(
          static_cast<int>(this->Before) + static_cast<int>(at - this->Share.begin()));
      }
    }
    answers = ExchangeLists(this->Ranks, answers);
    for (std::size_t rank = 0; rank < count; ++rank)
    {
      for (std::size_t i = 0; i < asked[rank].size(); ++i)
      {
        numbers[static_cast<std::size_t>(asked[rank][i].Vertex)] = answers[rank][i];
      }
    }
  }

private:
  Communicator& Ranks;
  std::vector<CurvePlace> Ends;
  std::vector<CurvePlace> Share; ///< Of all ranks' vertices, in order.
  std::size_t Before = 0;        ///< So many are on the shares before.
  std::size_t All = 0;
};

/** Vertices that are not among some, but neighbours of these: ring by ring. */
class RingsAbout
{
public:
  RingsAbout(const SurfaceMesh& mesh, const std::vector<int>& vertices)
    : Mesh(mesh), Last(vertices)
  {
    MakeZeroed(this->IsKnown, mesh.Rings.size());
    for (const int v : vertices)
    {
      this->IsKnown[v] = 1;
    }
  }

  /** @return the next one, in no order */
  std::vector<int> Next()
  {
    std::vector<int> next;
    for (const int v : this->Last)
    {
      const Ring& ring = this->Mesh.Rings[v];
      for (int i = 0; i < ring.Count; ++i)
      {
        const int w = ring.Item[i];
        if (!this->Mesh.IsAlive(w))
        {
          throw std::logic_error("A vertex near those of a rank is not there.");
        }
        if (!std::exchange(this->IsKnown[w], 1))
        {
          next.push_back(w);
        }
      }
    }
    this->Last = next;
    return next;
  }

private:
  const SurfaceMesh& Mesh;
  LargeVector<std::uint8_t> IsKnown;
  std::vector<int> Last;
};

void Append(std::vector<int>& list, const std::vector<int>& more)
{
  list.insert(list.end(), more.begin(), more.end());
}
}

MeshPiece RenumberWhole(SurfaceMesh mesh, double cell, Executor& executor)
{
  MeshPiece piece;
  piece.Mesh = std::move(mesh);
  piece.Mesh.Reorder(SpaceFillingOrder(piece.Mesh, cell, executor), executor);
  piece.Own.resize(piece.Mesh.Rings.size());
  std::iota(piece.Own.begin(), piece.Own.end(), 0);
  return piece;
}

MeshPiece RenumberOnRanks(Communicator& ranks, const SurfaceMesh& mesh,
  const std::vector<int>& own, double cell, Executor& executor)
{
  const Vector low = LowestOfRanks(ranks, mesh, own);
  const auto placesOf = [&](const std::vector<int>& vertices)
  {
    std::vector<CurvePlace> places;
    places.reserve(vertices.size());
    for (const int v : vertices)
    {
      places.push_back({ MortonCode(mesh.Position[v], low, cell), v });
    }
    return places;
  };
  RingsAbout rings(mesh, own);
  std::vector<int> others = rings.Next();
  Append(others, rings.Next());
  LargeVector<int> numbers;
  MakeZeroed(numbers, mesh.Rings.size());
  std::vector<int> asked = own;
  Append(asked, others);
  Append(asked, rings.Next());
  const CurveNumbers curve(ranks, placesOf(own), executor);
  curve.Find(placesOf(asked), numbers);

  MeshPiece piece;
  const std::size_t n = curve.NumberOfVertices();
  piece.Mesh.Remake(n, static_cast<int>(n));
  const auto take = [&](const std::vector<int>& vertices, std::vector<int>& taken)
  {
    taken.reserve(vertices.size());
    for (const int v : vertices)
    {
      const int number = numbers[v];
      taken.push_back(number);
      piece.Mesh.Position[number] = mesh.Position[v];
      const Ring& from = mesh.Rings[v];
      Ring& ring = piece.Mesh.Rings[number];
      ring.Count = from.Count;
      std::transform(from.Item, from.Item + from.Count, ring.Item,
        [&numbers](int w) { return numbers[w]; });
    }
    std::sort(taken.begin(), taken.end());
  };
  take(own, piece.Own);
  take(others, piece.Others);
  return piece;
}

SurfaceMesh GatherMesh(Communicator& ranks, SurfaceMesh mesh, const std::vector<int>& own)
{
  MessageWriter writer;
  SurfaceState::WriteMesh(mesh, writer, own);
  Message message = writer.Take();
  const bool isFirst = ranks.Rank() == 0;
  SurfaceMesh whole;
  if (isFirst)
  {
    whole.Remake(mesh.Rings.size(), mesh.NumberOfVertices());
  }
  mesh = SurfaceMesh();
  for (int rank = 0; rank < ranks.NumberOfRanks(); ++rank)
  {
    if (isFirst)
    {
      const Message piece = ranks.Pass(rank, 0, rank == 0 ? std::move(message) : Message());
      MessageReader reader(piece);
      SurfaceState::ReadMesh(reader, whole);
    }
    else if (rank == ranks.Rank())
    {
      ranks.Pass(rank, 0, std::move(message));
    }
  }
  return whole;
}

DivisionNumbers NumberForDivision(Communicator& ranks, const MeshPiece& piece,
  const KeptEdges* kept, Executor& executor)
{
  const SurfaceMesh& mesh = piece.Mesh;
  if (ranks.NumberOfRanks() == 1)
  {
    return NumberForDivision(mesh, kept, executor);
  }
  const auto number = [&](LargeVector<int>& first, const std::function<int(int)>& countOf)
  {
    const VertexNumbers numbers =
      NumberOnRanks(ranks, mesh.Rings.size(), countOf, piece.Own, piece.Others);
    MakeZeroed(first, mesh.Rings.size());
    for (const std::vector<int>* const list : { &piece.Own, &piece.Others })
    {
      for (const int v : *list)
      {
        first[v] = numbers.Of[v].Face;
      }
    }
    return numbers.All.Face;
  };
  DivisionNumbers numbers;
  numbers.Faces = number(numbers.FirstFace, FacesOf(mesh));
  if (kept)
  {
    numbers.Middles = number(numbers.FirstMiddle, [kept](int v) { return kept->CountFrom(v); });
  }
  return numbers;
}

std::vector<int> DividedOf(
  const MeshPiece& piece, const DivisionNumbers& numbers, const KeptEdges* kept)
{
  std::vector<int> divided = piece.Own;
  const auto add = [&divided](int first, int count)
  {
    for (int i = first; i < first + count; ++i)
    {
      divided.push_back(i);
    }
  };
  const int olds = piece.Mesh.Size();
  const std::function<int(int)> facesOf = FacesOf(piece.Mesh);
  for (const int v : piece.Own)
  {
    add(olds + numbers.FirstFace[v], facesOf(v));
  }
  for (const int v : piece.Own)
  {
    if (kept)
    {
      add(olds + numbers.Faces + numbers.FirstMiddle[v], kept->CountFrom(v));
    }
  }
  return divided;
}
}
