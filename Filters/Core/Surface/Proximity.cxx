// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Proximity.h"

#include "Core/Common/Box.h"
#include "Core/Mesh/TriangleTests.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace volumic
{
namespace
{
// Lengths in delta.
/** Room between two stars that needs no test of their triangles. */
constexpr float LeastRoom = 2e-3f;
/** Room that the test of triangles looks for first, to spare some tests to come. */
constexpr float SomeRoom = 0.01f;
/** Items of a list that one thread takes at a time. */
constexpr std::size_t ListGrain = 4096;
/** Room along the normals that needs no look for more along the line between the vertices. */
constexpr float EnoughRoom = 0.02f;
/** Slack of a vertex with nothing else in reach. */
constexpr float ReachSlack = 0.1f;
/** A slow vertex looks this much further, and needs no new look for longer. */
constexpr float FurtherReach = 0.25f;
/** Pairs are kept while their vertices use up their slack: look a little further. */
constexpr float PairReach = SizingField::LambdaInDelta + ReachSlack;

/** Least cosine between two faces at an edge that are certainly not folded onto each other. */
constexpr float Unfolded = -0.99f;
/** By what a squared reach is less, so that rounding can't make each of two pairs leave a test to
    the other. */
constexpr float RoundedReach = 0.999f;
/** By what a room in floats must be more than the same in doubles. */
constexpr float FloatRounding = 1.2f;

/** Room between the stars of v and w along a unit direction, v's side below; negative: none. */
float RoomAlong(const SurfaceMesh& mesh, int v, int w, const Vector& direction)
{
  float highest = Dot(direction, mesh.Position[v]);
  for (int i = 0; i < mesh.Rings[v].Count; ++i)
  {
    highest = std::max(highest, Dot(direction, mesh.Position[mesh.Rings[v].Item[i]]));
  }
  float lowest = Dot(direction, mesh.Position[w]);
  for (int i = 0; i < mesh.Rings[w].Count && lowest > highest; ++i)
  {
    lowest = std::min(lowest, Dot(direction, mesh.Position[mesh.Rings[w].Item[i]]));
  }
  return lowest - highest;
}

float RoomBetween(const SurfaceState& state, int v, int w)
{
  const Vector across = state.Mesh.Position[w] - state.Mesh.Position[v];
  Vector direction = state.Normal[v].Axis() - state.Normal[w].Axis();
  if (Dot(direction, across) < 0)
  {
    direction = -direction;
  }
  const float room = RoomAlong(state.Mesh, v, w, Normalized(direction));
  return room > EnoughRoom * state.Sizing.At(v)
    ? room
    : std::max(room, RoomAlong(state.Mesh, v, w, Normalized(across)));
}

/** A vertex and the faces about it. */
struct Star
{
  Star(const SurfaceMesh& mesh, int v)
    : Centre(v)
    , Neighbours(mesh.Rings[v])
    , Place(mesh.Position[v])
  {
    for (int i = 0; i < this->Neighbours.Count; ++i)
    {
      this->Rim[i] = mesh.Position[this->Neighbours.Item[i]];
    }
    for (int i = 0; i < this->Neighbours.Count; ++i)
    {
      const Vector& a = this->Rim[i];
      const Vector& b = this->Rim[this->After(i)];
      this->Bounds[i] = Box::Of(this->Place, a, b);
      this->Normal[i] = Normalized(Cross(a - this->Place, b - this->Place));
    }
  }
  int After(int i) const { return i + 1 < this->Neighbours.Count ? i + 1 : 0; }
  std::array<int, 3> Face(int i) const
  {
    return { this->Centre, this->Neighbours.Item[i], this->Neighbours.Next(i) };
  }

  int Centre;
  const Ring& Neighbours;
  Vector Place;
  Vector Rim[Ring::Capacity];
  Box Bounds[Ring::Capacity];    ///< Of the faces.
  Vector Normal[Ring::Capacity]; ///< Unit, of the faces.
};

/**
 * Whether face j of `other`, less a corner that it shares with face i of `star`, lies on one side
 * of the plane of face i, by more than `room`; or, if they share an edge, whether the two are far
 * from folded onto each other. Then they do not intersect.
 */
bool IsBesidePlane(const Star& star, int i, const Star& other, int j, float room)
{
  const int a = star.Centre;
  const int b = star.Neighbours.Item[i];
  const int c = star.Neighbours.Item[star.After(i)];
  const int name[3] = { other.Centre, other.Neighbours.Item[j],
    other.Neighbours.Item[other.After(j)] };
  const Vector* place[3] = { &other.Place, &other.Rim[j], &other.Rim[other.After(j)] };
  bool above = true;
  bool below = true;
  int shared = 0;
  for (int k = 0; k < 3; ++k)
  {
    if (name[k] == a || name[k] == b || name[k] == c)
    {
      ++shared;
    }
    else
    {
      const float height = Dot(star.Normal[i], *place[k] - star.Place);
      above = above && height > room;
      below = below && height < -room;
    }
  }
  return shared < 2 ? above || below : Dot(star.Normal[i], other.Normal[j]) > Unfolded;
}

bool SameFace(const std::array<int, 3>& f, const std::array<int, 3>& g)
{
  const auto has = [&g](int v) { return g[0] == v || g[1] == v || g[2] == v; };
  return has(f[0]) && has(f[1]) && has(f[2]);
}

/**
 * Two faces are found from up to nine pairs of their corners. Only the first pair, in order of
 * index, that an examination would look at tests them.
 */
class FirstPair
{
public:
  FirstPair(const SurfaceState& state, const std::vector<std::uint8_t>& listed, int v, int w)
    : State(state)
    , Listed(listed)
    , V(std::min(v, w))
    , W(std::max(v, w))
  {
  }

  bool IsFirstOf(const std::array<int, 3>& f, const std::array<int, 3>& g) const
  {
    for (int a : f)
    {
      for (int b : g)
      {
        const int x = std::min(a, b);
        const int y = std::max(a, b);
        if ((x < this->V || (x == this->V && y < this->W)) &&
          (this->Listed[x] || this->Listed[y]) && this->IsWithinReach(x, y) &&
          this->State.AreOpposed(x, y))
        {
          return false;
        }
      }
    }
    return true;
  }

private:
  bool IsWithinReach(int x, int y) const
  {
    const float reach = this->State.Sizing.Reach(x);
    return SquaredDistance(this->State.Mesh.Position[x], this->State.Mesh.Position[y]) <=
      RoundedReach * reach * reach;
  }

  const SurfaceState& State;
  const std::vector<std::uint8_t>& Listed;
  int V;
  int W;
};

/** Adds the faces that intersect. @return the room that the rest has for certain. */
float TestStars(const SurfaceState& state, const std::vector<std::uint8_t>& listed,
  const Star& first, int w, std::vector<Proximity::FacePair>& intersections,
  std::vector<int>& tight)
{
  const int v = first.Centre;
  const Star second(state.Mesh, w);
  const FirstPair pair(state, listed, v, w);
  const float someRoom = SomeRoom * state.Sizing.At(v);
  const float beside = FloatRounding * someRoom;
  float room = someRoom;
  for (int i = 0; i < first.Neighbours.Count; ++i)
  {
    const Box bounds = first.Bounds[i].Grown(room);
    for (int j = v == w ? i + 1 : 0; j < second.Neighbours.Count; ++j)
    {
      if (bounds.IsApartFrom(second.Bounds[j]) || IsBesidePlane(first, i, second, j, beside) ||
        IsBesidePlane(second, j, first, i, beside))
      {
        continue;
      }
      const std::array<int, 3> f = first.Face(i);
      const std::array<int, 3> g = second.Face(j);
      if (SameFace(f, g) || !pair.IsFirstOf(f, g))
      {
        continue; // Tested from the first pair; see Tight for what that finds.
      }
      const MeshTriangle one = TriangleOf(state.Mesh, f[0], f[1], f[2]);
      const MeshTriangle other = TriangleOf(state.Mesh, g[0], g[1], g[2]);
      if (TrianglesIntersect(one, other, someRoom))
      {
        room = 0;
        tight.insert(tight.end(), f.begin(), f.end());
        tight.insert(tight.end(), g.begin(), g.end());
        if (TrianglesIntersect(one, other, state.Sizing.Contact(v)))
        {
          intersections.push_back({ f, g });
        }
      }
    }
  }
  return room;
}
}

void Proximity::ExamineVertex(SurfaceState& state, int v, Block& block) const
{
  const SurfaceMesh& mesh = state.Mesh;
  const Vector p = mesh.Position[v];
  const float delta = state.Sizing.At(v);
  const float reach = state.Sizing.Reach(v);
  const float further = reach + (state.IsSlow[v] ? FurtherReach * delta : 0.f);
  const float near = PairReach * delta;
  const float least = ReachSlack * delta;
  std::optional<Star> own; // Few vertices need it, those that do need it often.
  const auto star = [&]() -> const Star&
  {
    if (!own)
    {
      own.emplace(mesh, v);
    }
    return *own;
  };
  bool anything = false;
  float slack = further - reach + least;
  if (state.AreOpposed(v, v))
  {
    anything = true;
    slack =
      std::min(slack, TestStars(state, this->Listed, star(), v, block.Intersections, block.Tight));
  }
  state.Grid.Visit(p, further,
    [&](int w)
    {
      const float squared = SquaredDistance(p, mesh.Position[w]);
      if (squared > further * further || w == v || !state.AreOpposed(v, w))
      {
        return;
      }
      if (squared > reach * reach)
      {
        slack = std::min(slack, std::sqrt(squared) - reach + least);
        return;
      }
      slack = std::min(
        slack, std::max(least, std::sqrt(squared) - state.Sizing.Clearance(v, w)));
      anything = true;
      if (squared < near * near && !mesh.AreNeighbours(v, w))
      {
        block.Pairs.push_back({ v, w, squared });
      }
      const float room = RoomBetween(state, v, w);
      if (room >= LeastRoom * delta)
      {
        slack = std::min(slack, room);
      }
      else if (v < w || !this->Listed[w])
      {
        slack = std::min(
          slack, TestStars(state, this->Listed, star(), w, block.Intersections, block.Tight));
      }
      else
      {
        slack = std::min(slack, SomeRoom * delta);
      }
    });
  state.NearOthers[v] = anything;
  state.Slack[v] = slack;
}

void Proximity::Examine(
  SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  this->Listed.resize(state.Mesh.Rings.size(), 0);
  const auto setListed = [&](std::uint8_t listed)
  {
    executor.For(vertices.size(), ListGrain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          this->Listed[vertices[i]] = listed;
        }
      });
  };
  setListed(1);
  constexpr std::size_t size = 512;
  const std::size_t blocks = (vertices.size() + size - 1) / size;
  if (this->Blocks.size() < blocks)
  {
    this->Blocks.resize(blocks);
  }
  ForBlocks(executor, vertices.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      this->Blocks[b].Pairs.clear();
      this->Blocks[b].Intersections.clear();
      this->Blocks[b].Tight.clear();
      for (std::size_t i = begin; i < end; ++i)
      {
        if (state.Mesh.IsAlive(vertices[i]))
        {
          this->ExamineVertex(state, vertices[i], this->Blocks[b]);
        }
      }
    });
  this->CollectPairs(state, blocks, executor);
  this->AllIntersections.clear();
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const Block& block = this->Blocks[b];
    this->AllIntersections.insert(
      this->AllIntersections.end(), block.Intersections.begin(), block.Intersections.end());
    // A pair of faces is tested once, but all its corners must know that it has no room.
    for (int v : block.Tight)
    {
      state.Slack[v] = 0;
    }
  }
  setListed(0);
}

void Proximity::CollectPairs(const SurfaceState& state, std::size_t blocks, Executor& executor)
{
  // Pairs of vertices that have not been examined anew stay.
  std::vector<std::vector<ClosePair>> lists((this->AllPairs.size() + ListGrain - 1) / ListGrain);
  ForBlocks(executor, this->AllPairs.size(), ListGrain,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      std::copy_if(this->AllPairs.begin() + static_cast<std::ptrdiff_t>(begin),
        this->AllPairs.begin() + static_cast<std::ptrdiff_t>(end), std::back_inserter(lists[b]),
        [&](const ClosePair& pair)
        {
          return !this->Listed[pair.V] && state.Mesh.IsAlive(pair.V) &&
            state.Mesh.IsAlive(pair.W);
        });
    });
  for (std::size_t b = 0; b < blocks; ++b)
  {
    lists.emplace_back();
    lists.back().swap(this->Blocks[b].Pairs);
  }
  std::vector<std::size_t> first(lists.size() + 1, 0);
  for (std::size_t b = 0; b < lists.size(); ++b)
  {
    first[b + 1] = first[b] + lists[b].size();
  }
  this->AllPairs.resize(first.back());
  ForBlocks(executor, lists.size(), 1,
    [&](std::size_t b, std::size_t, std::size_t)
    {
      std::copy(lists[b].begin(), lists[b].end(),
        this->AllPairs.begin() + static_cast<std::ptrdiff_t>(first[b]));
    });
}
}
