// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How LatticeCutter ends objects at the sides of a box.

#include "Core/Interfaces/LatticeCutter.h"

#include <algorithm>
#include <limits>

namespace volumic
{
namespace
{
/**
 * How far the first sites beyond the sides of a box are moved away from them, in voxels along each
 * axis: so none is on a plane; edges of the lattice leave the box by the side that SideAt() tells,
 * which they do where it is the furthest; and edges between sites beyond two sides pass by the box,
 * which they do as the last ones in it are half a voxel from its sides.
 */
constexpr std::array<double, 3> Beyond = { 1.2, 1.1, 1. };

float& CoordinateOf(Vector& place, int axis)
{
  return axis == 0 ? place.X : axis == 1 ? place.Y : place.Z;
}

float CoordinateOf(const Vector& place, int axis)
{
  return axis == 0 ? place.X : axis == 1 ? place.Y : place.Z;
}
}

LatticeCutter::Number LatticeCutter::SideAt(const std::array<int, 3>& halves) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int twice = this->Pitch[axis] * halves[axis];
    const bool isBefore = twice < 2 * this->Box.First[axis];
    if (isBefore || twice > 2 * this->Box.End[axis] - 2)
    {
      return static_cast<Number>(this->Mesh.FirstSide + 2 * axis + (isBefore ? 0 : 1));
    }
  }
  return 0;
}

void LatticeCutter::PutOnSide(Vector& place, int side) const
{
  CoordinateOf(place, this->Mesh.AxisOf(side)) = this->Mesh.PlaneOf(side);
}

bool LatticeCutter::HasSides(int i, int j, int k) const
{
  const std::array<int, 3> brick = { i, j, k };
  VoxelBox about;
  for (int axis = 0; axis < 3; ++axis)
  {
    about.First[axis] = LabelBricks::Side * brick[axis] - this->Pitch[axis];
    about.End[axis] = LabelBricks::Side * (brick[axis] + 1) + this->Pitch[axis];
  }
  const VoxelBox inside = about.CommonWith(this->Box);
  return this->Mesh.FirstSide <= std::numeric_limits<Number>::max() && !inside.IsEmpty() &&
    !(inside == about);
}

Vector LatticeCutter::OnSidesOf(
  const Tetrahedron& cell, const std::vector<int>& ends, const Vector& middle) const
{
  const auto put = [&](Vector place)
  {
    for (const LatticeSite& site : cell.Corner)
    {
      if (this->Mesh.IsSide(site.Object))
      {
        this->PutOnSide(place, site.Object);
      }
    }
    return place;
  };
  Vector sum;
  int count = 0;
  for (const int v : ends)
  {
    const Vector& place = this->Mesh.Position[static_cast<std::size_t>(v)];
    if (SquaredDistance(put(place), place) == 0.f)
    {
      sum += place;
      ++count;
    }
  }
  return put(count > 0 ? sum * (1.f / static_cast<float>(count)) : middle);
}

Vector LatticeCutter::PlaceOf(const LatticeSite& site) const
{
  std::array<double, 3> place;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int twice = this->Pitch[axis] * site.At[axis];
    const double beyond = Beyond[axis] - 0.5 * (this->Pitch[axis] - 1);
    const double moved = twice < 2 * this->Box.First[axis] ? -beyond
      : twice > 2 * this->Box.End[axis] - 2                ? beyond
                                                           : 0.;
    place[axis] = this->Fields.Step()[axis] * (0.5 * twice + moved);
  }
  return Vector(VectorD(place[0], place[1], place[2]));
}

LatticeCutter::Number LatticeCutter::FirstSideOf(const LatticeSite& a, const LatticeSite& b) const
{
  const auto [first, last] = std::minmax(a.Object, b.Object);
  return this->Mesh.IsSide(first) ? first : this->Mesh.IsSide(last) ? last : Number(0);
}

float LatticeCutter::ShareOf(const LatticeSite& from, const LatticeSite& to, int side) const
{
  const int axis = this->Mesh.AxisOf(side);
  const float start = CoordinateOf(this->PlaceOf(from), axis);
  return (this->Mesh.PlaneOf(side) - start) / (CoordinateOf(this->PlaceOf(to), axis) - start);
}

Vector LatticeCutter::OnSidesOf(const std::array<const LatticeSite*, 3>& sites)
{
  const auto placeOn = [&](const LatticeSite& p, const LatticeSite& q)
  {
    const int vertex = this->VertexOn(p, q);
    return this->Mesh.Position[static_cast<std::size_t>(vertex)];
  };
  const int last = sites[2]->Object;
  if (!this->Mesh.IsSide(sites[1]->Object))
  {
    Vector middle = (placeOn(*sites[0], *sites[2]) + placeOn(*sites[1], *sites[2])) * 0.5f;
    this->PutOnSide(middle, last);
    return middle;
  }
  // From one point of the first side to another one, to where the second one is.
  const Vector start = placeOn(*sites[0], *sites[1]);
  const Vector way = placeOn(*sites[1], *sites[2]) - start;
  const int axis = this->Mesh.AxisOf(last);
  Vector place = start +
    way * ((this->Mesh.PlaneOf(last) - CoordinateOf(start, axis)) / CoordinateOf(way, axis));
  this->PutOnSide(place, last);
  return place;
}
}
