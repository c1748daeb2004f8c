// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarFaces_h
#define volumicStarFaces_h

#include "Core/Common/Lanes.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <array>

namespace volumic
{
/** A number for each neighbour of a vertex, or each face, four of which are worked on at once. */
struct StarNumbers
{
  Lanes At(int i) const { return Lanes::Load(this->Item + i); } ///< Those from i on.
  void Set(int i, const Lanes& four) { four.Store(this->Item + i); }
  float operator[](int i) const { return this->Item[i]; }
  /** The first two follow the last once more. */
  void Close(int count)
  {
    this->Item[count] = this->Item[0];
    this->Item[count + 1] = this->Item[1];
  }

  alignas(16) float Item[Ring::Capacity + 1 + Lanes::Count];
};

/** The same for vectors. */
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
  /** In their order. */
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
 * A vertex and the places of its neighbours. Sets of these, or of the faces, are bits: face i lies
 * between the neighbours i and i + 1.
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
  /** Of bits about the neighbours: those of the neighbour after each. */
  unsigned Following(unsigned bits) const
  {
    return (bits >> 1 | bits << (this->Count - 1)) & this->All();
  }
  /** The neighbours that are this vertex: one or none. */
  unsigned Matching(int vertex) const
  {
    unsigned bits = 0;
    for (int i = 0; i < this->Count; i += Lanes::Count)
    {
      bits |= EqualBits(this->Item + i, vertex) << i;
    }
    return bits & this->All();
  }
  /** Whether this star and the star of another vertex, with this ring, have a common vertex. */
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
  int Item[Ring::Capacity + 1]; ///< The neighbours; four may be read from every fourth on.
  Vector Place;
  StarVectors Link; ///< Places of the neighbours; after the last follow the first two.
};

/** A star with what tells its faces from those of others. */
struct StarFaces : StarLink
{
  StarFaces(const SurfaceMesh& mesh, int v);

  StarVectors Low; ///< Of the faces' boxes.
  StarVectors High;
  StarVectors Normal; ///< Unit, of the faces.
};
}

#endif
