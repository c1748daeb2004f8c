// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarIntersections.h"

#include "Core/Surface/FaceShape.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Clearance along the normals, in delta, from which on no other direction is tested. */
constexpr float SufficientClearance = 0.02f;
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
}

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

namespace
{
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
}

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
}
