// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarFaces_h
#define volumicStarFaces_h

#include "Core/Common/Lanes.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <array>

namespace volumic
{
/** A number per neighbour or face of a vertex, for SIMD access to four at once. */
struct StarNumbers
{
  Lanes At(int i) const { return Lanes::Load(this->Item + i); } ///< The four from i on.
  void Set(int i, const Lanes& four) { four.Store(this->Item + i); }
  float operator[](int i) const { return this->Item[i]; }
  /** Append copies of the first two. */
  void Close(int count)
  {
    this->Item[count] = this->Item[0];
    this->Item[count + 1] = this->Item[1];
  }

  alignas(16) float Item[Ring::Capacity + 1 + Lanes::Count];
};

/** A vector per neighbour or face. */
struct StarVectors
{
  VectorLanes At(int i) const { return VectorLanes(this->X.At(i), this->Y.At(i), this->Z.At(i)); }
  void Set(int i, const VectorLanes& four)
  {
    this->X.Set(i, four.X);
    this->Y.Set(i, four.Y);
    this->Z.Set(i, four.Z);
  }
  Vector operator[](int i) const { return Vector(this->X[i], this->Y[i], this->Z[i]); }
  void Close(int count)
  {
    this->X.Close(count);
    this->Y.Close(count);
    this->Z.Close(count);
  }
  /** Return the sum, in order. */
  Vector Sum(int count) const
  {
    Vector sum;
    for (int i = 0; i < count; ++i)
    {
      sum.X += this->X[i];
      sum.Y += this->Y[i];
      sum.Z += this->Z[i];
    }
    return sum;
  }

  StarNumbers X;
  StarNumbers Y;
  StarNumbers Z;
};

/**
 * A vertex and the positions of its neighbours. Sets of neighbours or faces are bit sets. Face i
 * lies between the neighbours i and i + 1.
 */
struct StarLink
{
  StarLink(const SurfaceMesh& mesh, int v);

  int After(int i) const { return i + 1 < this->Count ? i + 1 : 0; }
  std::array<int, 3> Face(int i) const
  {
    return { this->Centre, this->Item[i], this->Item[this->After(i)] };
  }
  unsigned All() const { return (1u << this->Count) - 1; }
  /** Return the bits of the next neighbours, cyclically. */
  unsigned Following(unsigned bits) const
  {
    return (bits >> 1 | bits << (this->Count - 1)) & this->All();
  }
  /** Return the bit of the neighbour with this index, or 0. */
  unsigned Matching(int vertex) const
  {
    unsigned bits = 0;
    for (int i = 0; i < this->Count; i += Lanes::Count)
    {
      bits |= EqualBits(this->Item + i, vertex) << i;
    }
    return bits & this->All();
  }
  /** Return whether this star shares a vertex with that of `other`, which has this ring. */
  bool Shares(int other, const Ring& ring) const
  {
    unsigned shared = this->Matching(other);
    for (int i = 0; i < ring.Count && shared == 0; ++i)
    {
      shared = this->Matching(ring.Item[i]);
    }
    return shared != 0;
  }

  int Centre;
  int Count;
  int Item[Ring::Capacity + 1]; ///< Neighbours; four may be read from every fourth on.
  Vector Position;
  StarVectors Link; ///< Positions of the neighbours, then the first two again.
};

/** A star with bounds and normals of its faces, for intersection tests. */
struct StarFaces : StarLink
{
  StarFaces(const SurfaceMesh& mesh, int v);

  StarVectors Low; ///< Bounds of the faces.
  StarVectors High;
  StarVectors Normal; ///< Unit normals of the faces.
};
}

#endif
