// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Proximity.h"

#include <algorithm>
#include <optional>

namespace volumic
{
namespace
{
/** Lengths in delta. Room between two stars that needs no test of their triangles. */
constexpr float LeastRoom = 2e-3f;
/** Room that the test of triangles looks for first, to spare some tests to come. */
constexpr float SomeRoom = 0.01f;
/** Slack of a vertex with nothing else in reach. */
constexpr float ReachSlack = 0.1f;
/** A slow vertex looks this much further, and may be left in peace for longer. */
constexpr float FurtherReach = 0.25f;
/** Pairs are kept while their vertices use up their slack: look a little further. */
constexpr float PairReach = constraint::NearestOthers + ReachSlack;

Vector Minimum(const Vector& a, const Vector& b)
{
  return Vector(std::min(a.X, b.X), std::min(a.Y, b.Y), std::min(a.Z, b.Z));
}
Vector Maximum(const Vector& a, const Vector& b)
{
  return Vector(std::max(a.X, b.X), std::max(a.Y, b.Y), std::max(a.Z, b.Z));
}
bool Apart(const Vector& lowA, const Vector& highA, const Vector& lowB, const Vector& highB)
{
  return lowA.X > highB.X || lowB.X > highA.X || lowA.Y > highB.Y || lowB.Y > highA.Y ||
    lowA.Z > highB.Z || lowB.Z > highA.Z;
}

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
  Vector direction = state.Normal[v] - state.Normal[w];
  direction.Unused = 0;
  if (Dot(direction, across) < 0)
  {
    direction = -direction;
  }
  const float room = RoomAlong(state.Mesh, v, w, Normalized(direction));
  return room > 0.02f * state.Delta ? room
                                    : std::max(room,
                                        RoomAlong(state.Mesh, v, w, Normalized(across)));
}

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
      this->Low[i] = Minimum(this->Place, Minimum(a, b));
      this->High[i] = Maximum(this->Place, Maximum(a, b));
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
  Vector Low[Ring::Capacity];
  Vector High[Ring::Capacity];
  Vector Normal[Ring::Capacity]; ///< Unit, of the faces.
};

/**
 * Whether face j of `other`, less a corner that it shares with face i of `star`, lies on one side
 * of the plane of face i, by more than `room`; or, if they share an edge, whether the two are far
 * from folded onto each other. Then they do not meet.
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
  return shared < 2 ? above || below : Dot(star.Normal[i], other.Normal[j]) > -0.99f;
}

bool SameFace(const std::array<int, 3>& f, const std::array<int, 3>& g)
{
  const auto has = [&g](int v) { return g[0] == v || g[1] == v || g[2] == v; };
  return has(f[0]) && has(f[1]) && has(f[2]);
}

/**
 * Two faces are met from up to nine pairs of their corners. Only the first pair, in order of
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
    const float reach = constraint::Reach * this->State.Delta;
    for (int a : f)
    {
      for (int b : g)
      {
        const int x = std::min(a, b);
        const int y = std::max(a, b);
        if ((x < this->V || (x == this->V && y < this->W)) &&
          (this->Listed[x] || this->Listed[y]) &&
          SquaredDistance(this->State.Mesh.Position[x], this->State.Mesh.Position[y]) <=
            0.999f * reach * reach &&
          this->State.AreOpposed(x, y))
        {
          return false;
        }
      }
    }
    return true;
  }

private:
  const SurfaceState& State;
  const std::vector<std::uint8_t>& Listed;
  int V;
  int W;
};

/** Adds the faces that meet. @return the room that the rest has for certain. */
float TestStars(const SurfaceState& state, const std::vector<std::uint8_t>& listed,
  const Star& first, int w, std::vector<Proximity::Meeting>& meetings, std::vector<int>& tight)
{
  const int v = first.Centre;
  const Star second(state.Mesh, w);
  const FirstPair pair(state, listed, v, w);
  float room = SomeRoom * state.Delta;
  const float beside = 1.2f * room; // With some to spare for the rounding of floats.
  for (int i = 0; i < first.Neighbours.Count; ++i)
  {
    const Vector margin(room, room, room);
    const Vector low = first.Low[i] - margin;
    const Vector high = first.High[i] + margin;
    for (int j = v == w ? i + 1 : 0; j < second.Neighbours.Count; ++j)
    {
      if (Apart(low, high, second.Low[j], second.High[j]))
      {
        continue;
      }
      if (IsBesidePlane(first, i, second, j, beside) ||
        IsBesidePlane(second, j, first, i, beside))
      {
        continue;
      }
      const std::array<int, 3> f = first.Face(i);
      const std::array<int, 3> g = second.Face(j);
      if (SameFace(f, g))
      {
        continue;
      }
      if (!pair.IsFirstOf(f, g))
      {
        continue; // Tested from there; see Tight for what it finds.
      }
      const MeshTriangle one = TriangleOf(state.Mesh, f[0], f[1], f[2]);
      const MeshTriangle other = TriangleOf(state.Mesh, g[0], g[1], g[2]);
      if (TrianglesIntersect(one, other, SomeRoom * state.Delta))
      {
        room = 0;
        tight.insert(tight.end(), f.begin(), f.end());
        tight.insert(tight.end(), g.begin(), g.end());
        if (TrianglesIntersect(one, other, constraint::Contact * state.Delta))
        {
          meetings.push_back({ f, g });
        }
      }
    }
  }
  return room;
}
}

MeshTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c)
{
  return { { a, b, c },
    { VectorD(mesh.Position[a]), VectorD(mesh.Position[b]), VectorD(mesh.Position[c]) } };
}

void Proximity::ExamineVertex(SurfaceState& state, int v, Block& block) const
{
  const SurfaceMesh& mesh = state.Mesh;
  const Vector p = mesh.Position[v];
  const float reach = constraint::Reach * state.Delta;
  const float further = reach + (state.Slow[v] ? FurtherReach * state.Delta : 0.f);
  const float near = PairReach * state.Delta;
  const float least = ReachSlack * state.Delta;
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
    slack = std::min(slack, TestStars(state, this->Listed, star(), v, block.Meetings, block.Tight));
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
        slack, std::max(least, std::sqrt(squared) - constraint::NearestOthers * state.Delta));
      anything = true;
      if (squared < near * near && !mesh.AreNeighbours(v, w))
      {
        block.Pairs.push_back({ v, w, squared });
      }
      const float room = RoomBetween(state, v, w);
      if (room >= LeastRoom * state.Delta)
      {
        slack = std::min(slack, room);
      }
      else if (v < w || !this->Listed[w])
      {
        slack = std::min(
          slack, TestStars(state, this->Listed, star(), w, block.Meetings, block.Tight));
      }
      else
      {
        slack = std::min(slack, SomeRoom * state.Delta);
      }
    });
  state.Near[v] = anything;
  state.Slack[v] = slack;
}

void Proximity::Examine(
  SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  this->Listed.resize(state.Mesh.Rings.size(), 0);
  for (int v : vertices)
  {
    this->Listed[v] = 1;
  }
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
      this->Blocks[b].Meetings.clear();
      this->Blocks[b].Tight.clear();
      for (std::size_t i = begin; i < end; ++i)
      {
        if (state.Mesh.IsAlive(vertices[i]))
        {
          this->ExamineVertex(state, vertices[i], this->Blocks[b]);
        }
      }
    });
  // Pairs of vertices that have not been examined anew stay.
  std::size_t kept = 0;
  for (const ClosePair& pair : this->AllPairs)
  {
    if (!this->Listed[pair.V] && state.Mesh.IsAlive(pair.V) && state.Mesh.IsAlive(pair.W))
    {
      this->AllPairs[kept++] = pair;
    }
  }
  this->AllPairs.resize(kept);
  this->AllMeetings.clear();
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const Block& block = this->Blocks[b];
    this->AllPairs.insert(this->AllPairs.end(), block.Pairs.begin(), block.Pairs.end());
    this->AllMeetings.insert(
      this->AllMeetings.end(), block.Meetings.begin(), block.Meetings.end());
    // A pair of faces is tested once, but all its corners must know that it has no room.
    for (int v : block.Tight)
    {
      state.Slack[v] = 0;
    }
  }
  for (int v : vertices)
  {
    this->Listed[v] = 0;
  }
}

bool NewFacesMeet(
  const SurfaceState& state, const std::vector<MeshTriangle>& faces, const GoneFaces& gone)
{
  const double tolerance = constraint::Contact * state.Delta;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    for (std::size_t j = i + 1; j < faces.size(); ++j)
    {
      if (TrianglesIntersect(faces[i], faces[j], tolerance))
      {
        return true;
      }
    }
  }
  // In floats first: a box and a plane set most pairs apart.
  struct Bounds
  {
    Vector Low;
    Vector High;
    Vector Normal; ///< Unit.
    Vector Place;
  };
  Vector low(faces[0].Corner[0]);
  Vector high = low;
  std::vector<Bounds> bounds;
  bounds.reserve(faces.size());
  for (const MeshTriangle& face : faces)
  {
    const Vector a(face.Corner[0]);
    const Vector b(face.Corner[1]);
    const Vector c(face.Corner[2]);
    bounds.push_back({ Minimum(a, Minimum(b, c)), Maximum(a, Maximum(b, c)),
      Normalized(Cross(b - a, c - a)), a });
    low = Minimum(low, bounds.back().Low);
    high = Maximum(high, bounds.back().High);
  }
  const float room = SomeRoom * state.Delta;
  // A face that meets one of the new ones has a corner this near to the box of those: lambda delta,
  // and some more for edges that are a little too long until the end of the iteration.
  const float reach = 1.1f * constraint::NearestOthers * state.Delta;
  const Vector margin(reach, reach, reach);
  const Vector lowVisited = low - margin;
  const Vector highVisited = high + margin;
  const SurfaceMesh& mesh = state.Mesh;
  const auto isVisited = [&](int w)
  {
    const Vector& p = mesh.Position[w];
    return p.X >= lowVisited.X && p.X <= highVisited.X && p.Y >= lowVisited.Y &&
      p.Y <= highVisited.Y && p.Z >= lowVisited.Z && p.Z <= highVisited.Z;
  };
  bool meets = false;
  state.Grid.VisitBox(lowVisited, highVisited,
    [&](int w)
    {
      if (meets || !isVisited(w))
      {
        return;
      }
      const Ring& ring = mesh.Rings[w];
      const Vector& p = mesh.Position[w];
      for (int i = 0; i < ring.Count && !meets; ++i)
      {
        const int u = ring.Item[i];
        const int v = ring.Next(i);
        // A face is tested from the smallest of its corners that are visited.
        if ((u < w && isVisited(u)) || (v < w && isVisited(v)))
        {
          continue;
        }
        const Vector& q = mesh.Position[u];
        const Vector& r = mesh.Position[v];
        const Vector lowest = Minimum(p, Minimum(q, r));
        const Vector highest = Maximum(p, Maximum(q, r));
        if (Apart(lowest, highest, low, high) || gone.Contains({ w, u, v }))
        {
          continue;
        }
        for (std::size_t k = 0; k < faces.size() && !meets; ++k)
        {
          const Bounds& b = bounds[k];
          if (Apart(lowest, highest, b.Low, b.High))
          {
            continue;
          }
          const float heights[3] = { Dot(b.Normal, p - b.Place), Dot(b.Normal, q - b.Place),
            Dot(b.Normal, r - b.Place) };
          meets = !(std::min({ heights[0], heights[1], heights[2] }) > room ||
                    std::max({ heights[0], heights[1], heights[2] }) < -room) &&
            TrianglesIntersect(faces[k], TriangleOf(mesh, w, u, v), tolerance);
        }
      }
    });
  return meets;
}
}
