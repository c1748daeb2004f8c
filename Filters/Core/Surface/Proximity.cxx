// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Proximity.h"

#include "Core/Common/Spans.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Surface/PairSearchRadius.h"
#include "Core/Surface/StarFaces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace volumic
{
namespace
{
// Lengths in delta.
/** Clearance of two stars above which their triangles are not tested. */
constexpr float LeastClearance = 2e-3f;
/** Clearance that the triangle test requires at first, so that later tests can be skipped. */
constexpr float TestedClearance = 0.01f;
constexpr std::size_t TestedSpan = 64;
/** Clearance along the normals above which the line between the vertices is not tested. */
constexpr float SufficientClearance = 0.02f;
/** Clearance of a vertex without others in its search radius. */
constexpr float ReachClearance = 0.1f;
/** Search radius of pairs, which are kept until their vertices have used up their clearance. */
constexpr float PairRadius = SizingField::LambdaInDelta + ReachClearance;

/** Least cosine between two faces at an edge that are certainly not folded onto each other. */
constexpr float Unfolded = -0.99f;
/** Margin of a squared search radius: one of two pairs must not leave a test to the other. */
constexpr float RadiusRounding = 0.999f;
/** Margin for rounding of a clearance in float instead of double. */
constexpr float FloatRounding = 1.2f;

/** Return the clearance along a unit direction, the first star below; negative: overlap. */
float ClearanceAlong(const StarLink& first, const StarLink& second, const Vector& direction)
{
  const VectorLanes along = AllLanes(direction);
  Lanes highest(Dot(direction, first.Position));
  for (int i = 0; i < first.Count; i += Lanes::Count)
  {
    highest = Maximum(highest, Dot(along, first.Link.At(i)));
  }
  Lanes lowest(Dot(direction, second.Position));
  for (int i = 0; i < second.Count; i += Lanes::Count)
  {
    lowest = Minimum(lowest, Dot(along, second.Link.At(i)));
  }
  return LeastOf(lowest) - GreatestOf(highest);
}

/** Return the larger clearance along two directions. The stars must not have a common vertex. */
float ClearanceBetween(const SurfaceState& state, const StarLink& first, const StarLink& second)
{
  const Vector across = second.Position - first.Position;
  Vector direction = state.Normal[first.Centre].Axis() - state.Normal[second.Centre].Axis();
  if (Dot(direction, across) < 0)
  {
    direction = -direction;
  }
  const float clearance = ClearanceAlong(first, second, Normalized(direction));
  return clearance > SufficientClearance * state.Sizing.At(first.Centre)
    ? clearance
    : std::max(clearance, ClearanceAlong(first, second, Normalized(across)));
}

/** Separates the faces of one star from those of another by their planes, as bits. */
class SeparatedFaces
{
public:
  /**
   * @param from star with the planes
   * @param other star whose faces are tested
   */
  SeparatedFaces(const StarFaces& from, const StarFaces& other, float clearance)
    : From(from), Other(other), Clearance(clearance), Centres(other.Matching(from.Centre))
  {
    for (int i = 0; i < from.Count; ++i)
    {
      this->Neighbours[i] = other.Matching(from.Item[i]);
    }
  }

  /**
   * Return the faces of the other star that cannot intersect face i. Apart from a shared corner
   * they lie on one side of its plane with the clearance, or they share an edge and are not folded.
   */
  unsigned Of(int i) const
  {
    const int after = this->From.After(i);
    const Vector normal = this->From.Normal[i];
    const unsigned shared = this->Centres | this->Neighbours[i] | this->Neighbours[after];
    const int centre = this->Other.Centre;
    const bool hasCentre = centre == this->From.Centre || centre == this->From.Item[i] ||
      centre == this->From.Item[after];
    const float height = Dot(normal, this->Other.Position - this->From.Position);
    unsigned above = shared;
    unsigned below = shared;
    const VectorLanes normals = AllLanes(normal);
    const VectorLanes position = AllLanes(this->From.Position);
    for (int k = 0; k < this->Other.Count; k += Lanes::Count)
    {
      const Lanes heights = Dot(normals, this->Other.Link.At(k) - position);
      above |= LessBits(Lanes(this->Clearance), heights) << k;
      below |= LessBits(heights, Lanes(-this->Clearance)) << k;
    }
    unsigned separated = 0;
    separated |= hasCentre || height > this->Clearance ? this->OfBothEnds(above) : 0;
    separated |= hasCentre || height < -this->Clearance ? this->OfBothEnds(below) : 0;
    // Faces that share an edge, or all corners.
    unsigned edges = this->OfBothEnds(shared);
    edges |= hasCentre ? shared | this->Other.Following(shared) : 0;
    separated &= ~edges;
    for (; edges != 0; edges &= edges - 1)
    {
      const int j = LowestBit(edges);
      separated |= Dot(normal, this->Other.Normal[j]) > Unfolded ? 1u << j : 0;
    }
    return separated;
  }

private:
  unsigned OfBothEnds(unsigned bits) const
  {
    bits &= this->Other.All();
    return bits & this->Other.Following(bits);
  }

  const StarFaces& From;
  const StarFaces& Other;
  float Clearance;
  unsigned Centres;                    ///< Neighbours in Other that are the centre of From.
  unsigned Neighbours[Ring::Capacity]; ///< The same for the neighbours of From.
};

/** Return the faces of a star whose boxes are within a margin of that of face i of another. */
unsigned FacesNear(const StarFaces& from, int i, const StarFaces& other, float margin)
{
  const VectorLanes by(margin, margin, margin);
  const VectorLanes low = AllLanes(from.Low[i]) - by;
  const VectorLanes high = AllLanes(from.High[i]) + by;
  unsigned apart = 0;
  for (int k = 0; k < other.Count; k += Lanes::Count)
  {
    const VectorLanes otherLow = other.Low.At(k);
    const VectorLanes otherHigh = other.High.At(k);
    apart |=
      (LessBits(otherHigh.X, low.X) | LessBits(high.X, otherLow.X) | LessBits(otherHigh.Y, low.Y) |
        LessBits(high.Y, otherLow.Y) | LessBits(otherHigh.Z, low.Z) | LessBits(high.Z, otherLow.Z))
      << k;
  }
  return ~apart & other.All();
}

bool SameFace(const std::array<int, 3>& f, const std::array<int, 3>& g)
{
  const auto has = [&g](int v) { return g[0] == v || g[1] == v || g[2] == v; };
  return has(f[0]) && has(f[1]) && has(f[2]);
}

/** Selects, of up to nine pairs of corners that find two faces, the first tested one. */
class FirstPair
{
public:
  FirstPair(const SurfaceState& state, int v, int w)
    : State(state), V(std::min(v, w)), W(std::max(v, w))
  {
  }

  bool IsFirstOf(const std::array<int, 3>& f, const std::array<int, 3>& g) const
  {
    // Upper bound of the radii, so that the stars of these pairs need not be read.
    float largest = 0.f;
    for (const int corner : { f[0], f[1], f[2], g[0], g[1], g[2] })
    {
      largest = std::max(largest, SizingField::SearchRadiusInDelta * this->State.Sizing.At(corner));
    }
    for (int a : f)
    {
      for (int b : g)
      {
        const int x = std::min(a, b);
        const int y = std::max(a, b);
        if ((x < this->V || (x == this->V && y < this->W)) &&
          ((this->State.Marks[x] | this->State.Marks[y]) & IsListed) &&
          this->IsWithinRadius(x, y, largest) && this->State.AreOpposed(x, y))
        {
          return false;
        }
      }
    }
    return true;
  }

private:
  bool IsWithinRadius(int x, int y, float largest) const
  {
    const float radius =
      std::min({ largest, this->State.Sizing.SearchRadius(x), this->State.Sizing.SearchRadius(y) });
    return SquaredDistance(this->State.Mesh.Position[x], this->State.Mesh.Position[y]) <=
      RadiusRounding * radius * radius;
  }

  const SurfaceState& State;
  int V;
  int W;
};

/** Append intersecting faces. Return the certain clearance of the others. */
float TestStars(const SurfaceState& state, const StarFaces& first, const StarFaces& second,
  Proximity::Findings& found)
{
  const int v = first.Centre;
  const FirstPair pair(state, v, second.Centre);
  const float testedClearance = TestedClearance * state.Sizing.At(v);
  const SeparatedFaces separatedFromFirst(first, second, FloatRounding * testedClearance);
  const SeparatedFaces separatedFromSecond(second, first, FloatRounding * testedClearance);
  std::array<unsigned, Ring::Capacity> firstSeparated;
  unsigned known = 0; // Faces of the second star with computed bits.
  float clearance = testedClearance;
  for (int i = 0; i < first.Count; ++i)
  {
    unsigned near = FacesNear(first, i, second, clearance);
    near &= v == second.Centre ? ~0u << i << 1 : ~0u; // Each pair of a star with itself once.
    near = near != 0 ? near & ~separatedFromFirst.Of(i) : 0;
    for (; near != 0; near &= near - 1)
    {
      const int j = LowestBit(near);
      if (!(known >> j & 1))
      {
        known |= 1u << j;
        firstSeparated[j] = separatedFromSecond.Of(j);
      }
      if (firstSeparated[j] >> i & 1)
      {
        continue;
      }
      const std::array<int, 3> f = first.Face(i);
      const std::array<int, 3> g = second.Face(j);
      if (SameFace(f, g))
      {
        continue;
      }
      const MeshTriangle one = TriangleOf(state.Mesh, f[0], f[1], f[2]);
      const MeshTriangle other = TriangleOf(state.Mesh, g[0], g[1], g[2]);
      // Only the first pair reports the intersection.
      if (TrianglesIntersect(one, other, testedClearance) && pair.IsFirstOf(f, g))
      {
        clearance = 0;
        found.Touching.insert(found.Touching.end(), f.begin(), f.end());
        found.Touching.insert(found.Touching.end(), g.begin(), g.end());
        if (TrianglesIntersect(one, other, state.Sizing.Contact(v)))
        {
          found.Intersections.push_back({ f, g });
        }
      }
    }
  }
  return clearance;
}

/** Tests vertices, with the buffers of one thread. */
class Search
{
public:
  Search(SurfaceState& state) : State(state) {}

  /** Call visit(w, squared distance) for vertices within a radius and with an opposed cone. */
  template <typename Visitor>
  void VisitOpposed(int v, float radius, const Visitor& visit);
  /** Set NearOthers and ClearanceAtTest of a vertex, except for Findings::Touching. */
  void Test(int v, Proximity::Findings& found);

private:
  /** Fill Near with the vertices within a radius of a position. Return their number. */
  std::size_t FindNear(const Vector& position, float radius);

  /** Capacity for one more group of visited vertices, rounded up to whole lanes. */
  static constexpr std::size_t GroupCapacity = VertexGrid::LargestGroup + Lanes::Count;

  SurfaceState& State;
  std::vector<int> Near = std::vector<int>(GroupCapacity);
  std::vector<float> Squared = std::vector<float>(GroupCapacity); ///< Squared distances.
  /** Star of the tested vertex, built on first use: most vertices do not need it. */
  std::vector<StarFaces> Own;
};

std::size_t Search::FindNear(const Vector& position, float radius)
{
  std::size_t visited = 0;
  const Vector margin(radius, radius, radius);
  this->State.Grid.VisitGroups(position - margin, position + margin,
    [&](const int* group, int count)
    {
      if (this->Near.size() < visited + GroupCapacity)
      {
        this->Near.resize(2 * visited + GroupCapacity);
        this->Squared.resize(this->Near.size());
      }
      for (int i = 0; i < count; i += Lanes::Count)
      {
        std::copy(group + i, group + i + Lanes::Count, this->Near.data() + visited + i);
      }
      visited += static_cast<std::size_t>(count);
    });
  int* const near = this->Near.data();
  float* const squared = this->Squared.data();
  std::fill_n(near + visited, Lanes::Count, near[0]);
  const Vector* const positions = this->State.Mesh.Position.data();
  const VectorLanes from = AllLanes(position);
  const Lanes largest(radius * radius);
  std::size_t count = 0;
  for (std::size_t i = 0; i < visited; i += Lanes::Count)
  {
    const int four[Lanes::Count] = { near[i], near[i + 1], near[i + 2], near[i + 3] };
    float distance[Lanes::Count];
    const Lanes lanes = SquaredLength(
      Gather(positions[four[0]], positions[four[1]], positions[four[2]], positions[four[3]]) -
      from);
    lanes.Store(distance);
    const unsigned beyond =
      LessBits(largest, lanes) | ~0u << std::min<std::size_t>(visited - i, Lanes::Count);
    for (int k = 0; k < Lanes::Count; ++k) // Branchless: vertices beyond are overwritten.
    {
      near[count] = four[k];
      squared[count] = distance[k];
      count += ~beyond >> k & 1u;
    }
  }
  return count;
}

template <typename Visitor>
void Search::VisitOpposed(int v, float radius, const Visitor& visit)
{
  const std::size_t count = this->FindNear(this->State.Mesh.Position[v], radius);
  const int* const near = this->Near.data();
  const NormalCone* const cones = this->State.Normal.AsVector().data();
  const NormalCone cone = cones[v];
  for (std::size_t i = 0; i < count; i += Lanes::Count)
  {
    const int* w = near + i; // Valid indices follow after the last one.
    unsigned opposed = OpposedBits(cone, cones[w[0]], cones[w[1]], cones[w[2]], cones[w[3]]);
    opposed &= ~(~0u << std::min<std::size_t>(count - i, Lanes::Count));
    for (; opposed != 0; opposed &= opposed - 1)
    {
      const int k = LowestBit(opposed);
      if (w[k] != v)
      {
        visit(w[k], this->Squared[i + k]);
      }
    }
  }
}

void Search::Test(int v, Proximity::Findings& found)
{
  SurfaceState& state = this->State;
  const SurfaceMesh& mesh = state.Mesh;
  const float delta = state.Sizing.At(v);
  const float largest = state.Sizing.SearchRadius(v);
  const PairSearchRadius pairRadius(state, v);
  const float extended =
    largest + (state.IsSlow[v] ? Proximity::ExtraSearchRadiusInDelta * delta : 0.f);
  const float near = PairRadius * delta;
  const float least = ReachClearance * delta;
  this->Own.clear();
  const auto star = [&]() -> const StarFaces&
  {
    if (this->Own.empty())
    {
      this->Own.emplace_back(mesh, v);
    }
    return this->Own.front();
  };
  bool anything = false;
  float clearanceOfStar = extended - largest + least;
  if (state.AreOpposed(v, v))
  {
    anything = true;
    clearanceOfStar = std::min(clearanceOfStar, TestStars(state, star(), star(), found));
  }
  this->VisitOpposed(v, extended,
    [&](int w, float squared)
    {
      const float radius = pairRadius.With(w, squared);
      if (squared > radius * radius)
      {
        clearanceOfStar = std::min(clearanceOfStar, std::sqrt(squared) - radius + least);
        return;
      }
      clearanceOfStar = std::min(
        clearanceOfStar, std::max(least, std::sqrt(squared) - state.Sizing.Clearance(v, w)));
      anything = true;
      if (squared < near * near && !mesh.AreNeighbours(v, w))
      {
        found.Pairs.push_back({ v, w, squared });
      }
      const StarFaces& first = star();
      const bool isShared = first.Shares(w, mesh.Rings[w]);
      const bool tests = v < w || !(state.Marks[w] & IsListed) ||
        squared >
          state.Sizing.SearchRadius(w) * state.Sizing.SearchRadius(w); // Its own radius is smaller.
      if (isShared && !tests)
      {
        clearanceOfStar = std::min(clearanceOfStar, TestedClearance * delta);
        return;
      }
      const StarFaces second(mesh, w);
      const float clearance = isShared ? 0.f : ClearanceBetween(state, first, second);
      clearanceOfStar = std::min(clearanceOfStar,
        clearance >= LeastClearance * delta ? clearance
          : tests                           ? TestStars(state, first, second, found)
                                            : TestedClearance * delta);
    });
  state.NearOthers[v] = anything;
  state.ClearanceAtTest[v] = clearanceOfStar;
}
}

void Proximity::AddPairs(SurfaceState& state, const std::vector<int>& vertices)
{
  Search search(state);
  for (const int v : vertices)
  {
    search.VisitOpposed(v, PairRadius * state.Sizing.At(v),
      [&](int w, float squared)
      {
        if (!state.Mesh.AreNeighbours(v, w))
        {
          this->AllPairs.push_back({ v, w, squared });
        }
      });
  }
}

void Proximity::Test(SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  for (const int v : vertices)
  {
    state.Marks[v] |= IsListed;
  }
  // Keep the pairs of vertices that are not tested.
  this->AllPairs.erase(std::remove_if(this->AllPairs.begin(), this->AllPairs.end(),
                         [&state](const ClosePair& pair)
                         {
                           return (state.Marks[pair.V] & IsListed) || !state.Mesh.IsAlive(pair.V) ||
                             !state.Mesh.IsAlive(pair.W);
                         }),
    this->AllPairs.end());
  const std::size_t spans = (vertices.size() + TestedSpan - 1) / TestedSpan;
  this->OfSpans.resize(std::max(this->OfSpans.size(), spans));
  executor.For(spans, 1,
    [&](std::size_t begin, std::size_t end)
    {
      Search search(state);
      for (std::size_t span = begin; span < end; ++span)
      {
        Proximity::Findings& found = this->OfSpans[span];
        found.Pairs.clear();
        found.Intersections.clear();
        found.Touching.clear();
        const std::size_t last = std::min(vertices.size(), (span + 1) * TestedSpan);
        for (std::size_t i = span * TestedSpan; i < last; ++i)
        {
          if (state.Mesh.IsAlive(vertices[i]))
          {
            search.Test(vertices[i], found);
          }
        }
      }
    });
  this->AllIntersections.clear();
  for (std::size_t span = 0; span < spans; ++span)
  {
    const Proximity::Findings& found = this->OfSpans[span];
    this->AllPairs.insert(this->AllPairs.end(), found.Pairs.begin(), found.Pairs.end());
    this->AllIntersections.insert(
      this->AllIntersections.end(), found.Intersections.begin(), found.Intersections.end());
    // Each pair of faces is tested once. Clear the clearance of all its corners.
    for (const int v : found.Touching)
    {
      state.ClearanceAtTest[v] = 0;
    }
  }
  for (const int v : vertices)
  {
    state.Marks[v] &= static_cast<std::uint8_t>(~IsListed);
  }
}

std::vector<Proximity::FacePair> Proximity::FindIntersections(
  SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  Proximity all;
  all.Test(state, vertices, executor);
  return std::move(all.AllIntersections);
}
}
