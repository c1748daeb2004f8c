// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/StarShape.h"

#include "Core/Surface/SurfaceState.h"

#include <algorithm>

namespace volumic
{
StarShape::StarShape(const SurfaceMesh& mesh, int v) : StarLink(mesh, v)
{
  const VectorLanes position = AllLanes(this->Position);
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    const VectorLanes edge = this->Link.At(i) - position;
    this->Edge.Set(i, edge);
    this->Length.Set(i, SquareRoot(Dot(edge, edge)));
  }
  this->Edge.Close(this->Count);
  this->Length.Close(this->Count);
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    const VectorLanes one = this->Edge.At(i);
    const VectorLanes next = this->Edge.At(i + 1);
    const VectorLanes normal = Cross(one, next);
    this->Normal.Set(i, normal);
    this->Size.Set(i, SquareRoot(Dot(normal, normal)));
    this->Inner.Set(i, Dot(one, next));
  }
  this->Size.Close(this->Count);
  this->Inner.Close(this->Count);
}

NormalCone StarShape::Cone() const
{
  const Vector axis = Normalized(this->Normal.Sum(this->Count));
  const VectorLanes axes = AllLanes(axis);
  StarNumbers cosines;
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    cosines.Set(i, Dot(this->Normal.At(i), axes) / this->Size.At(i));
  }
  float cosine = 1;
  for (int i = 0; i < this->Count; ++i)
  {
    cosine = std::min(cosine, this->Size[i] > 0 ? cosines[i] : -1.f);
  }
  return NormalCone(axis, cosine);
}

bool StarShape::IsDelaunay() const
{
  const Lanes least(LeastCotangentSum);
  unsigned flipped = 0;
  for (int i = 0; i < this->Count; i += Lanes::Count)
  {
    // Test the edge after each one: the angles opposite to it are at the ends of this edge and of
    // the next but one.
    const Lanes before = this->Length.At(i);
    const Lanes after = this->Length.At(i + 2);
    const Lanes a = before * before - this->Inner.At(i);
    const Lanes b = after * after - this->Inner.At(i + 1);
    const Lanes sizeA = this->Size.At(i);
    const Lanes sizeB = this->Size.At(i + 1);
    // a / sizeA + b / sizeB < least, without division.
    flipped |= LessBits(a * sizeB + b * sizeA, least * sizeB * sizeA) << i;
  }
  return (flipped & this->All()) == 0;
}
}
