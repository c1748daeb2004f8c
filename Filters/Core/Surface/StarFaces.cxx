// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarFaces.h"

#include <algorithm>

namespace volumic
{
StarLink::StarLink(const SurfaceMesh& mesh, int v)
  : Centre(v), Count(mesh.Rings[v].Count), Position(mesh.Position[v])
{
  std::copy(mesh.Rings[v].Item, mesh.Rings[v].Item + Ring::Capacity, this->Item);
  this->Item[Ring::Capacity] = -1;
  const auto position = [&](int i) -> const Vector&
  { return mesh.Position[this->Item[i < this->Count ? i : 0]]; };
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    this->Link.Set(i, Gather(position(i), position(i + 1), position(i + 2), position(i + 3)));
  }
  this->Link.Close(this->Count);
}

StarFaces::StarFaces(const SurfaceMesh& mesh, int v) : StarLink(mesh, v)
{
  const VectorLanes position = AllLanes(this->Position);
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    const VectorLanes a = this->Link.At(i);
    const VectorLanes b = this->Link.At(i + 1);
    this->Low.Set(i, Minimum(position, Minimum(a, b)));
    this->High.Set(i, Maximum(position, Maximum(a, b)));
    this->Normal.Set(i, Normalized(Cross(a - position, b - position)));
  }
}
}
