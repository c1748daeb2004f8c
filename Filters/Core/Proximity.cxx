// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Proximity.h"

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
/** Largest slack, which is what a vertex far from all others gets. */
constexpr float MostSlack = 0.1f;
/** Pairs are kept while their vertices use up their slack: look a little further. */
constexpr float PairReach = constraint::NearestOthers + MostSlack;

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
  {
    const Vector p = mesh.Position[v];
    for (int i = 0; i < this->Neighbours.Count; ++i)
    {
      const Vector& a = mesh.Position[this->Neighbours.Item[i]];
      const Vector& b = mesh.Position[this->Neighbours.Next(i)];
      this->Low[i] = Minimum(p, Minimum(a, b));
      this->High[i] = Maximum(p, Maximum(a, b));
    }
  }
  std::array<int, 3> Face(int i) const
  {
    return { this->Centre, this->Neighbours.Item[i], this->Neighbours.Next(i) };
  }

  int Centre;
  const Ring& Neighbours;
  Vector Low[Ring::Capacity];
  Vector High[Ring::Capacity];
};

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
      const NamedTriangle one = TriangleOf(state.Mesh, f[0], f[1], f[2]);
      const NamedTriangle other = TriangleOf(state.Mesh, g[0], g[1], g[2]);
      if (TrianglesMeet(one, other, SomeRoom * state.Delta))
      {
        room = 0;
        tight.insert(tight.end(), f.begin(), f.end());
        tight.insert(tight.end(), g.begin(), g.end());
        if (TrianglesMeet(one, other, constraint::Contact * state.Delta))
        {
          meetings.push_back({ f, g });
        }
      }
    }
  }
  return room;
}
}

NamedTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c)
{
  return { { a, b, c },
    { VectorD(mesh.Position[a]), VectorD(mesh.Position[b]), VectorD(mesh.Position[c]) } };
}

void Proximity::ExamineVertex(SurfaceState& state, int v, Block& block) const
{
  const SurfaceMesh& mesh = state.Mesh;
  const Vector p = mesh.Position[v];
  const float reach = constraint::Reach * state.Delta;
  const float near = PairReach * state.Delta;
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
  float slack = MostSlack * state.Delta;
  if (state.AreOpposed(v, v))
  {
    anything = true;
    slack = std::min(slack, TestStars(state, this->Listed, star(), v, block.Meetings, block.Tight));
  }
  state.Grid.Visit(p, reach,
    [&](int w)
    {
      const float squared = SquaredDistance(p, mesh.Position[w]);
      if (squared > reach * reach || w == v || !state.AreOpposed(v, w))
      {
        return;
      }
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
  const SurfaceState& state, const std::vector<NamedTriangle>& faces, const GoneFaces& gone)
{
  const double tolerance = constraint::Contact * state.Delta;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    for (std::size_t j = i + 1; j < faces.size(); ++j)
    {
      if (TrianglesMeet(faces[i], faces[j], tolerance))
      {
        return true;
      }
    }
  }
  Vector low(faces[0].Corner[0]);
  Vector high = low;
  std::vector<std::pair<Vector, Vector>> boxes;
  boxes.reserve(faces.size());
  for (const NamedTriangle& face : faces)
  {
    const Vector a(face.Corner[0]);
    const Vector b(face.Corner[1]);
    const Vector c(face.Corner[2]);
    boxes.emplace_back(Minimum(a, Minimum(b, c)), Maximum(a, Maximum(b, c)));
    low = Minimum(low, boxes.back().first);
    high = Maximum(high, boxes.back().second);
  }
  const Vector centre = (low + high) * 0.5f;
  const float radius = 0.5f * Length(high - low) + constraint::Reach * state.Delta;
  const SurfaceMesh& mesh = state.Mesh;
  bool meets = false;
  state.Grid.Visit(centre, radius,
    [&](int w)
    {
      if (meets || SquaredDistance(centre, mesh.Position[w]) > radius * radius)
      {
        return;
      }
      const Star star(mesh, w);
      for (int i = 0; i < star.Neighbours.Count && !meets; ++i)
      {
        if (Apart(star.Low[i], star.High[i], low, high))
        {
          continue;
        }
        const std::array<int, 3> g = star.Face(i);
        if (gone.Contains(g))
        {
          continue;
        }
        const NamedTriangle other = TriangleOf(mesh, g[0], g[1], g[2]);
        for (std::size_t k = 0; k < faces.size() && !meets; ++k)
        {
          meets = !Apart(star.Low[i], star.High[i], boxes[k].first, boxes[k].second) &&
            TrianglesMeet(faces[k], other, tolerance);
        }
      }
    });
  return meets;
}
}
