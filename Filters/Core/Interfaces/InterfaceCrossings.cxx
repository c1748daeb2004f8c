// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceCrossings.h"

#include "Core/Common/Spans.h"
#include "Core/Interfaces/InterfaceClearance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace volumic
{
namespace
{
/** Faces, or cubes, that a thread looks at at a time. */
constexpr std::size_t SpanSize = 2048;
/** How wide cubes are, in the mean width of faces. */
constexpr float CubeInFaces = 2.f;
/** Bits of a cube's number along an axis. */
constexpr int Bits = 20;
constexpr int Last = (1 << Bits) - 1;

/** A face and one of the cubes that its box is in. */
struct Place
{
  std::uint64_t Cube;
  int Face;

  bool operator<(const Place& other) const
  {
    return std::tie(this->Cube, this->Face) < std::tie(other.Cube, other.Face);
  }
};

class CrossingFinder
{
public:
  CrossingFinder(const InterfaceMesh& mesh, double tolerance, Executor& executor)
    : Mesh(mesh), Tolerance(tolerance), Threads(executor)
  {
  }

  InterfaceCrossings Find()
  {
    this->LayCubes();
    std::vector<Place> places = this->FindPlaces();
    SortInSpans(this->Threads, places);
    std::vector<std::vector<std::array<int, 2>>> pairs((places.size() + SpanSize - 1) / SpanSize);
    std::vector<std::vector<int>> doubtful(pairs.size());
    ForSpans(this->Threads, places.size(), SpanSize,
      [&](std::size_t span, std::size_t begin, std::size_t end)
      {
        // Cubes that begin in the span.
        while (begin > 0 && begin < end && places[begin].Cube == places[begin - 1].Cube)
        {
          ++begin;
        }
        while (begin < end)
        {
          std::size_t next = begin;
          while (next < places.size() && places[next].Cube == places[begin].Cube)
          {
            ++next;
          }
          this->LookAt(places.data() + begin, places.data() + next, pairs[span], doubtful[span]);
          begin = next;
        }
      });
    InterfaceCrossings found;
    found.Pairs = Joined(this->Threads, pairs);
    found.Doubtful = Joined(this->Threads, doubtful);
    SortInSpans(this->Threads, found.Doubtful);
    found.Doubtful.erase(
      std::unique(found.Doubtful.begin(), found.Doubtful.end()), found.Doubtful.end());
    return found;
  }

private:
  TriangleBox BoxOf(int face) const
  {
    const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    const Vector* at = this->Mesh.Position.data();
    TriangleBox box(at[v[0]], at[v[1]], at[v[2]]);
    const auto thick = static_cast<float>(this->Tolerance);
    box.High += Vector(thick, thick, thick);
    return box;
  }

  void LayCubes()
  {
    const std::size_t count = this->Mesh.Faces.size();
    std::vector<TriangleBox> boxes((count + SpanSize - 1) / SpanSize);
    std::vector<double> widths(boxes.size(), 0.);
    std::vector<std::size_t> counts(boxes.size(), 0);
    ForSpans(this->Threads, count, SpanSize,
      [&](std::size_t span, std::size_t begin, std::size_t end)
      {
        for (std::size_t f = begin; f < end; ++f)
        {
          if (this->Mesh.Faces[f].IsThere())
          {
            const TriangleBox box = this->BoxOf(static_cast<int>(f));
            boxes[span] = counts[span] == 0 ? box : boxes[span];
            boxes[span].Add(box);
            const Vector sides = box.High - box.Low;
            widths[span] += std::max({ sides.X, sides.Y, sides.Z });
            ++counts[span];
          }
        }
      });
    TriangleBox all;
    double width = 0.;
    std::size_t there = 0;
    for (std::size_t span = 0; span < boxes.size(); ++span)
    {
      if (counts[span] > 0)
      {
        all = there == 0 ? boxes[span] : all;
        all.Add(boxes[span]);
        width += widths[span];
        there += counts[span];
      }
    }
    this->Low = all.Low;
    const Vector sides = all.High - all.Low;
    this->PerCube = 1.f /
      std::max({ 1e-6f, CubeInFaces * static_cast<float>(width / std::max<std::size_t>(there, 1)),
        std::max({ sides.X, sides.Y, sides.Z }) / static_cast<float>(Last) });
  }

  /** The cube of a place, along each axis. */
  std::array<int, 3> CubeOf(const Vector& place) const
  {
    const Vector from = (place - this->Low) * this->PerCube;
    return { std::clamp(static_cast<int>(from.X), 0, Last),
      std::clamp(static_cast<int>(from.Y), 0, Last), std::clamp(static_cast<int>(from.Z), 0, Last) };
  }
  static std::uint64_t NumberOf(const std::array<int, 3>& cube)
  {
    return (static_cast<std::uint64_t>(cube[2]) << Bits | static_cast<std::uint64_t>(cube[1]))
      << Bits |
      static_cast<std::uint64_t>(cube[0]);
  }

  std::vector<Place> FindPlaces() const
  {
    std::vector<std::vector<Place>> ofSpans((this->Mesh.Faces.size() + SpanSize - 1) / SpanSize);
    ForSpans(this->Threads, this->Mesh.Faces.size(), SpanSize,
      [&](std::size_t span, std::size_t begin, std::size_t end)
      {
        for (std::size_t f = begin; f < end; ++f)
        {
          if (!this->Mesh.Faces[f].IsThere())
          {
            continue;
          }
          const TriangleBox box = this->BoxOf(static_cast<int>(f));
          const std::array<int, 3> low = this->CubeOf(box.Low);
          const std::array<int, 3> high = this->CubeOf(box.High);
          for (int k = low[2]; k <= high[2]; ++k)
          {
            for (int j = low[1]; j <= high[1]; ++j)
            {
              for (int i = low[0]; i <= high[0]; ++i)
              {
                ofSpans[span].push_back({ NumberOf({ i, j, k }), static_cast<int>(f) });
              }
            }
          }
        }
      });
    return Joined(this->Threads, ofSpans);
  }

  /** The faces of a cube. */
  void LookAt(const Place* first, const Place* last, std::vector<std::array<int, 2>>& pairs,
    std::vector<int>& doubtful) const
  {
    if (this->AreOneSheet(first, last))
    {
      return;
    }
    for (const Place* f = first; f != last; ++f)
    {
      doubtful.push_back(f->Face);
      const TriangleBox box = this->BoxOf(f->Face);
      const MeshTriangle triangle = this->TriangleAt(f->Face);
      for (const Place* g = f + 1; g != last; ++g)
      {
        const TriangleBox other = this->BoxOf(g->Face);
        if (box.IsApart(other.Low, other.High))
        {
          continue;
        }
        // In the first cube that both are in.
        const Vector low(std::max(box.Low.X, other.Low.X), std::max(box.Low.Y, other.Low.Y),
          std::max(box.Low.Z, other.Low.Z));
        if (NumberOf(this->CubeOf(low)) == f->Cube &&
          TrianglesIntersect(triangle, this->TriangleAt(g->Face), this->Tolerance))
        {
          pairs.push_back({ f->Face, g->Face });
        }
      }
    }
  }

  MeshTriangle TriangleAt(int face) const
  {
    return TriangleOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex);
  }

  bool AreOneSheet(const Place* first, const Place* last) const
  {
    const auto faceOf = [this](const Place& place) -> const InterfaceMesh::Face&
    { return this->Mesh.Faces[static_cast<std::size_t>(place.Face)]; };
    const InterfaceMesh::Face& one = faceOf(*first);
    VectorD sum;
    for (const Place* f = first; f != last; ++f)
    {
      const InterfaceMesh::Face& face = faceOf(*f);
      if (face.Behind != one.Behind || face.Front != one.Front)
      {
        return false;
      }
      sum += this->Mesh.NormalOf(face);
    }
    const VectorD along = Normalized(sum);
    return std::all_of(first, last,
      [&](const Place& place)
      {
        const VectorD normal = this->Mesh.NormalOf(faceOf(place));
        return Dot(normal, along) > LeastSheetCosine * Length(normal);
      });
  }

  const InterfaceMesh& Mesh;
  double Tolerance;
  Executor& Threads;
  Vector Low;
  float PerCube = 1.f;
};
}

InterfaceCrossings FindCrossings(const InterfaceMesh& mesh, double tolerance, Executor& executor)
{
  return CrossingFinder(mesh, tolerance, executor).Find();
}
}
