// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarFaces.h"

#include <algorithm>

namespace volumic
{
StarLink::StarLink(const SurfaceMesh& mesh, int v)
  : Centre(v), Count(mesh.Rings[v].Count), Place(mesh.Position[v])
{
  std::copy(mesh.Rings[v].Item, mesh.Rings[v].Item + Ring::Capacity, this->Item);
  this->Item[Ring::Capacity] = -1;
  const auto place = [&](int i) -> const Vector&
  { return mesh.Position[this->Item[i < this->Count ? i : 0]]; };
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    this->Link.Set(i, Gather(place(i), place(i + 1), place(i + 2), place(i + 3)));
  }
  this->Link.Close(this->Count);
}

StarFaces::StarFaces(const SurfaceMesh& mesh, int v) : StarLink(mesh, v)
{
  const VectorLanes place = AllLanes(this->Place);
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    const VectorLanes a = this->Link.At(i);
    const VectorLanes b = this->Link.At(i + 1);
    this->Low.Set(i, Minimum(place, Minimum(a, b)));
    this->High.Set(i, Maximum(place, Maximum(a, b)));
    this->Normal.Set(i, Normalized(Cross(a - place, b - place)));
  }
}
}
