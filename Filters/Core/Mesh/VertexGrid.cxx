// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/VertexGrid.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** A box much larger than what the surface could fill must not cost memory without limit. */
constexpr double MaximumNumberOfCells = 1 << 26;
/** What cells grow by until they are few enough. */
constexpr float CellGrowth = 1.25f;
}

void VertexGrid::Reset(const Vector& low, const Vector& high, float cell)
{
  const auto count = [&](float from, float to)
  { return std::max(1., std::ceil(static_cast<double>(to - from) / cell)); };
  while (count(low.X, high.X) * count(low.Y, high.Y) * count(low.Z, high.Z) > MaximumNumberOfCells)
  {
    cell *= CellGrowth;
  }
  this->Size[0] = static_cast<int>(count(low.X, high.X));
  this->Size[1] = static_cast<int>(count(low.Y, high.Y));
  this->Size[2] = static_cast<int>(count(low.Z, high.Z));
  this->Low[0] = low.X;
  this->Low[1] = low.Y;
  this->Low[2] = low.Z;
  this->Inverse = 1.f / cell;
  this->Head.assign(static_cast<std::size_t>(this->Size[0]) * this->Size[1] * this->Size[2], -1);
  this->Next.clear();
  this->Cell.clear();
}

void VertexGrid::Insert(int v, const Vector& position)
{
  if (v >= static_cast<int>(this->Cell.size()))
  {
    this->Cell.resize(v + 1, -1);
    this->Next.resize(v + 1, -1);
  }
  this->Link(v, this->CellOf(position));
}

void VertexGrid::Remove(int v)
{
  int* link = &this->Head[this->Cell[v]];
  while (*link != v)
  {
    link = &this->Next[*link];
  }
  *link = this->Next[v];
  this->Cell[v] = -1;
}
}
