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
constexpr std::size_t SpanSize = 4096;
/**
 * Distance by which faces may extend beyond their cube, and edge length of a cube, both in longest
 * edge lengths. An edit writes within 1 edge of its face, and reads within 2.5 edges. Both include
 * the grid cells there, which are at most 1 edge wide. Two cubes of one colour are independent if
 * they are 2 * 1 + 1 + 2.5 + 2 edges apart.
 */
constexpr float MarginInEdges = 1.f;
constexpr float SideInEdges = 7.5f;
/** Bits of the index of a cube along an axis. */
constexpr int Bits = 20;
constexpr std::uint64_t Last = (std::uint64_t(1) << Bits) - 1;

/** A face and the cube that contains its middle. */
struct FaceInCube
{
  std::uint64_t Colour; ///< parities of the indices of the cube
  std::uint64_t Cube;   ///< indices of the cube along the axes
  int Face;

  bool operator<(const FaceInCube& other) const
  {
    return std::tie(this->Colour, this->Cube, this->Face) <
      std::tie(other.Colour, other.Cube, other.Face);
  }
};

FaceInCube CubeOf(const Vector& fromLow, float side, int face)
{
  FaceInCube result = { 0, 0, face };
  for (const float length : { fromLow.Z, fromLow.Y, fromLow.X })
  {
    const auto number = std::min(Last, static_cast<std::uint64_t>(std::max(0.f, length / side)));
    result.Colour = result.Colour << 1 | (number & 1);
    result.Cube = result.Cube << Bits | number;
  }
  return result;
}

Box BoxOf(std::uint64_t cube, const Vector& low, float side)
{
  const auto along = [&](int axis)
  { return side * static_cast<float>(cube >> (Bits * axis) & Last); };
  const Vector from = low + Vector(along(0), along(1), along(2));
  return { from, from + Vector(side, side, side) };
}

class CubeEdits
{
public:
  /** @param region box that contains all edited faces */
  CubeEdits(const InterfaceMesh& mesh, const InterfaceClearance& clearance, const Box& region)
    : Mesh(mesh), Clearance(clearance), Region(region)
  {
  }

  void FindFaces(const FaceInCube* first, const FaceInCube* last)
  {
    for (; first != last; ++first)
    {
      if (this->Mesh.Faces[static_cast<std::size_t>(first->Face)].IsThere())
      {
        (this->IsNear(first->Face) ? this->Faces : this->Remaining).push_back(first->Face);
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
        this->Remaining.push_back(face);
      }
    }
  }

  std::vector<int> Remaining; ///< faces left for the serial pass
  int Count = 0;

private:
  /** Return whether an edit of a face is independent of the edits in other cubes. */
  bool IsNear(int face) const
  {
    const std::array<int, 3>& v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
    const Box& box = this->Clearance.BoxOf(face);
    return this->Region.Contains(box.Low) && this->Region.Contains(box.High) &&
      std::none_of(v.begin(), v.end(), [this](int corner) { return this->Mesh.HasImages(corner); });
  }

  const InterfaceMesh& Mesh;
  const InterfaceClearance& Clearance;
  Box Region;
  std::vector<int> Faces;
};
}

InterfaceRemesher::InterfaceRemesher(InterfaceMesh& mesh, double shortest, double longest,
  double tolerance, Executor& executor, std::function<bool()> shouldContinue)
  : Mesh(mesh), ShouldContinue(std::move(shouldContinue)), Threads(executor),
    Clearance(mesh, tolerance), Shortest(shortest), Longest(longest)
{
}

void InterfaceRemesher::UpdateGrid()
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
  // New faces are appended, and hence visited as well.
  for (std::size_t f = 0; f < this->Mesh.Faces.size() && this->CanContinue(f); ++f)
  {
    count += this->Mesh.Faces[f].IsThere() && edits.TrySplit(static_cast<int>(f)) ? 1 : 0;
  }
  this->HasGrid = this->HasGrid && count == 0;
  return count;
}

int InterfaceRemesher::RemoveSlivers()
{
  this->UpdateGrid();
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
  return std::max(now, static_cast<float>(this->Longest * InterfaceEdits::CornerFactor) * size);
}

template <typename Visit>
int InterfaceRemesher::VisitInCubes(const Visit& visit)
{
  if (this->Mesh.Faces.empty())
  {
    return 0;
  }
  this->UpdateGrid();
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
        some.push_back(CubeOf(this->Clearance.BoxOf(face).Middle() - low, side, face));
      }
    });
  Sort(this->Threads, faces);
  std::vector<std::vector<int>> remaining;
  int count = 0;
  for (std::size_t n = 0; n < faces.size() && this->ShouldContinue();)
  {
    const std::uint64_t colour = faces[n].Colour;
    std::vector<CubeEdits> cubes;
    std::vector<std::size_t> first;
    for (; n < faces.size() && faces[n].Colour == colour; ++n)
    {
      if (first.empty() || faces[n].Cube != faces[n - 1].Cube)
      {
        first.push_back(n);
        cubes.emplace_back(this->Mesh, this->Clearance,
          BoxOf(faces[n].Cube, low, side).Grown(MarginInEdges * longest));
      }
    }
    first.push_back(n);
    // Select the faces of all cubes before the first edit.
    ForSpans(this->Threads, cubes.size(), 1,
      [&](std::size_t w, std::size_t, std::size_t)
      { cubes[w].FindFaces(faces.data() + first[w], faces.data() + first[w + 1]); });
    ForSpans(this->Threads, cubes.size(), 1,
      [&](std::size_t w, std::size_t, std::size_t) { cubes[w].Run(this->Edits(), visit); });
    for (CubeEdits& cube : cubes)
    {
      count += cube.Count;
      remaining.push_back(std::move(cube.Remaining));
    }
  }
  std::vector<int> serial = Joined(this->Threads, remaining);
  std::sort(serial.begin(), serial.end());
  InterfaceEdits edits = this->Edits();
  for (std::size_t n = 0; n < serial.size() && this->CanContinue(n); ++n)
  {
    const int face = serial[n];
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
