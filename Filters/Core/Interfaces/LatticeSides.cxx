// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How LatticeCutter ends objects at the sides of a box.

#include "Core/Interfaces/LatticeCutter.h"

#include <algorithm>

namespace volumic
{
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
  return this->Fields.HaveBox() && !inside.IsEmpty() && !(inside == about);
}

bool LatticeCutter::IsInBox(const std::array<int, 3>& cube, int axis) const
{
  VoxelBox box = this->Box;
  --box.First[axis];
  return !this->Fields.HaveBox() || box.Contains(cube);
}

Vector LatticeCutter::PlaceOf(const LatticeSite& site) const
{
  std::array<double, 3> place;
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] = this->Fields.Step()[axis] * (0.5 * this->Pitch[axis] * site.At[axis]);
  }
  return Vector(VectorD(place[0], place[1], place[2]));
}

Vector LatticeCutter::InSidesOf(const std::array<const LatticeSite*, 3>& sites, Vector place) const
{
  const auto isIn = [&](std::size_t axis)
  {
    const int at = sites[0]->At[axis];
    return this->Fields.HaveBox() && at == sites[1]->At[axis] && at == sites[2]->At[axis];
  };
  const Vector side = this->PlaceOf(*sites[0]);
  place.X = isIn(0) ? side.X : place.X;
  place.Y = isIn(1) ? side.Y : place.Y;
  place.Z = isIn(2) ? side.Z : place.Z;
  return place;
}

void LatticeCutter::CutSide(
  const std::array<LatticeSite, 3>& corners, const LatticeSite& inside, int axis)
{
  const int plane = corners[0].At[axis];
  LatticeSite beyond = inside;
  beyond.At[axis] = 2 * plane - inside.At[axis];
  beyond.Object =
    static_cast<Number>(this->Mesh.FirstSide + 2 * axis + (plane < inside.At[axis] ? 0 : 1));
  const auto add = [&](const LatticeSite& own, const std::array<int, 3>& vertices) {
    this->AddTriangle(vertices, { inside.At, own.Object }, beyond);
  };
  const auto isSame = [&](int a, int b) { return corners[a].Object == corners[b].Object; };
  if (isSame(0, 1) && isSame(1, 2))
  {
    if (corners[0].Object != 0)
    {
      add(corners[0],
        { this->VertexAt(corners[0]), this->VertexAt(corners[1]), this->VertexAt(corners[2]) });
    }
    return;
  }
  const bool areThree = !isSame(0, 1) && !isSame(1, 2) && !isSame(0, 2);
  for (int n = 0; n < 3; ++n)
  {
    const LatticeSite& own = corners[n];
    const LatticeSite& next = corners[(n + 1) % 3];
    const LatticeSite& last = corners[(n + 2) % 3];
    if (areThree)
    {
      const int middle = this->VertexOn(corners[0], corners[1], corners[2]);
      const int between = this->VertexOn(own, next);
      add(own, { this->VertexAt(own), between, middle });
      add(next, { between, this->VertexAt(next), middle });
    }
    else if (next.Object == last.Object)
    {
      const int toNext = this->VertexOn(own, next);
      const int toLast = this->VertexOn(own, last);
      add(own, { this->VertexAt(own), toNext, toLast });
      add(next, { toNext, this->VertexAt(next), this->VertexAt(last) });
      add(next, { toNext, this->VertexAt(last), toLast });
    }
  }
}

InterfaceMesh LatticeCutter::Take()
{
  this->Mesh.FindStrata();
  if (this->Fields.HaveBox())
  {
    this->Mesh.Compact(); // Background has no faces in sides.
  }
  if (this->Fields.ArePeriodic())
  {
    this->Mesh.MatchSides();
  }
  return std::move(this->Mesh);
}
}
