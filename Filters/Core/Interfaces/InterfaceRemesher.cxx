// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceRemesher.h"

#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Faces that a thread looks at at a time. */
constexpr std::size_t SpanSize = 4096;
/**
 * In longest edges: how far faces may come out of their cube, and how wide a cube is. An edit
 * writes what is within an edge of its face, and the cells of the grid there, which are as wide as
 * an edge at most. It reads what is within two edges and a half, and the cells there: two cubes of
 * a colour have nothing in common if there are 2 * 1 + 1 + 2.5 + 2 edges between them.
 */
constexpr float MarginInEdges = 1.f;
constexpr float SideInEdges = 7.5f;
/** Bits of a cube's number along an axis. */
constexpr int Bits = 20;
constexpr std::uint64_t Last = (std::uint64_t(1) << Bits) - 1;

/** A cube and one of its faces, that whose middle is in it. */
struct FaceInCube
{
  std::uint64_t Colour; ///< the cube's parities: between two of a colour there is another one
  std::uint64_t Cube;   ///< its numbers along the axes
  int Face;

  bool operator<(const FaceInCube& other) const
  {
    return std::tie(this->Colour, this->Cube, this->Face) <
      std::tie(other.Colour, other.Cube, other.Face);
  }
};

FaceInCube IjkOf(const Vector& fromLow, float side, int face)
{
  FaceInCube place = { 0, 0, face };
  for (const float length : { fromLow.Z, fromLow.Y, fromLow.X })
  {
    const auto number = std::min(Last, static_cast<std::uint64_t>(std::max(0.f, length / side)));
    place.Colour = place.Colour << 1 | (number & 1);
    place.Cube = place.Cube << Bits | number;
  }
  return place;
}

Box BoxOf(std::uint64_t cube, const Vector& low, float side)
{
  const auto along = [&](int axis)
  { return side * static_cast<float>(cube >> (Bits * axis) & Last); };
  const Vector from = low + Vector(along(0), along(1), along(2));
  return { from, from + Vector(side, side, side) };
}

/** What is to be done in a cube. */
class CubeEdits
{
public:
  /** @param share of space, in which edits are made */
  CubeEdits(const InterfaceMesh& mesh, const InterfaceClearance& clearance, const Box& share)
    : Mesh(mesh), Clearance(clearance), Share(share)
  {
  }

  /** The faces in the cube. */
  void FindFaces(const FaceInCube* first, const FaceInCube* last)
  {
    for (; first != last; ++first)
    {
      if (this->Mesh.Faces[static_cast<std::size_t>(first->Face)].IsThere())
      {
        (this->IsNear(first->Face) ? this->Faces : this->Left).push_back(first->Face);
      }
    }
  }

  template <typename Visit>
  void Run(InterfaceEdits edits, const Visit& visit)
  {
    for (const int face : this->Faces)
    {
      if (!this->Mesh.Faces[static_cast<std::size_t>(face)].IsThere())
      {
        continue;
      }
      if (this->IsNear(face))
      {
        this->Count += visit(edits, face);
      }
      else
      {
        this->Left.push_back(face);
      }
    }
  }

  std::vector<int> Left; ///< what is not done here
  int Count = 0;         ///< of edits

private:
  /** Whether an edit at a face touches nothing that those in other cubes do. */
  bool IsNear(int face) const
  {
    const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    const Box& box = this->Clearance.BoxOf(face);
    return this->Share.Contains(box.Low) && this->Share.Contains(box.High) &&
      std::none_of(v.begin(), v.end(), [this](int corner) { return this->Mesh.HasImages(corner); });
  }

  const InterfaceMesh& Mesh;
  const InterfaceClearance& Clearance;
  Box Share;
  std::vector<int> Faces;
};
}

InterfaceRemesher::InterfaceRemesher(InterfaceMesh& mesh, double shortest, double longest,
  double tolerance, Executor& executor, std::function<bool()> goOn)
  : Mesh(mesh), GoOn(std::move(goOn)), Threads(executor), Clearance(mesh, tolerance),
    Shortest(shortest), Longest(longest)
{
}

void InterfaceRemesher::LayGrid()
{
  if (!this->HasGrid)
  {
    this->Clearance.Reset(this->Threads);
    this->HasGrid = true;
  }
}

int InterfaceRemesher::SplitLongEdges()
{
  InterfaceEdits edits = this->Edits();
  int count = 0;
  // New faces are looked at in their turn.
  for (std::size_t f = 0; f < this->Mesh.Faces.size() && this->CanContinue(f); ++f)
  {
    count += this->Mesh.Faces[f].IsThere() && edits.TrySplit(static_cast<int>(f)) ? 1 : 0;
  }
  this->HasGrid = this->HasGrid && count == 0;
  return count;
}

int InterfaceRemesher::RemoveSlivers()
{
  this->LayGrid();
  InterfaceEdits edits = this->Edits();
  int count = 0;
  for (std::size_t f = 0; f < this->Mesh.Faces.size() && this->CanContinue(f); ++f)
  {
    count += this->Mesh.Faces[f].IsThere() && edits.RemoveSliver(static_cast<int>(f)) ? 1 : 0;
  }
  return count;
}

float InterfaceRemesher::LongestEdge() const
{
  const InterfaceMesh& mesh = this->Mesh;
  std::vector<float> longest((mesh.Faces.size() + SpanSize - 1) / SpanSize, 0.f);
  std::vector<float> largest = longest;
  ForSpans(this->Threads, mesh.Faces.size(), SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        for (int k = 0; k < 3 && mesh.Faces[f].IsThere(); ++k)
        {
          const auto u = static_cast<std::size_t>(mesh.Faces[f].Vertex[k]);
          const auto v = static_cast<std::size_t>(mesh.Faces[f].Vertex[(k + 1) % 3]);
          longest[span] =
            std::max(longest[span], SquaredDistance(mesh.Position[u], mesh.Position[v]));
          largest[span] = std::max(largest[span], mesh.Size[u]);
        }
      }
    });
  const float now = std::sqrt(*std::max_element(longest.begin(), longest.end()));
  const float size = *std::max_element(largest.begin(), largest.end());
  return std::max(now, static_cast<float>(this->Longest * InterfaceEdits::CornerClearance) * size);
}

template <typename Visit>
int InterfaceRemesher::VisitInCubes(const Visit& visit)
{
  if (this->Mesh.Faces.empty())
  {
    return 0;
  }
  this->LayGrid();
  const float longest = this->LongestEdge();
  this->Clearance.ExpectEdges(longest);
  const float side = SideInEdges * longest;
  const Vector low = this->Clearance.Bounds().Low;
  auto faces = CollectInSpans<FaceInCube>(this->Threads, this->Mesh.Faces.size(), SpanSize,
    [&](std::size_t f, std::vector<FaceInCube>& some)
    {
      if (this->Mesh.Faces[f].IsThere())
      {
        const int face = static_cast<int>(f);
        some.push_back(IjkOf(this->Clearance.BoxOf(face).Middle() - low, side, face));
      }
    });
  Sort(this->Threads, faces);
  std::vector<std::vector<int>> left;
  int count = 0;
  for (std::size_t n = 0; n < faces.size() && this->GoOn();)
  {
    // The cubes of one colour.
    const std::uint64_t colour = faces[n].Colour;
    std::vector<CubeEdits> works;
    std::vector<std::size_t> first;
    for (; n < faces.size() && faces[n].Colour == colour; ++n)
    {
      if (first.empty() || faces[n].Cube != faces[n - 1].Cube)
      {
        first.push_back(n);
        works.emplace_back(this->Mesh, this->Clearance,
          BoxOf(faces[n].Cube, low, side).Grown(MarginInEdges * longest));
      }
    }
    first.push_back(n);
    // What comes out of its cube is found before the first one is edited.
    ForSpans(this->Threads, works.size(), 1,
      [&](std::size_t w, std::size_t, std::size_t)
      { works[w].FindFaces(faces.data() + first[w], faces.data() + first[w + 1]); });
    ForSpans(this->Threads, works.size(), 1,
      [&](std::size_t w, std::size_t, std::size_t) { works[w].Run(this->Edits(), visit); });
    for (CubeEdits& work : works)
    {
      count += work.Count;
      left.push_back(std::move(work.Left));
    }
  }
  std::vector<int> rest = Joined(this->Threads, left);
  std::sort(rest.begin(), rest.end());
  InterfaceEdits edits = this->Edits();
  for (std::size_t n = 0; n < rest.size() && this->CanContinue(n); ++n)
  {
    const int face = rest[n];
    count += this->Mesh.Faces[static_cast<std::size_t>(face)].IsThere() ? visit(edits, face) : 0;
  }
  return count;
}

int InterfaceRemesher::CollapseShortEdges()
{
  return this->VisitInCubes([](InterfaceEdits& edits, int face) { return edits.CollapseAt(face); });
}

int InterfaceRemesher::FlipEdges()
{
  return this->VisitInCubes([](InterfaceEdits& edits, int face) { return edits.FlipAt(face); });
}
}
