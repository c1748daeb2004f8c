// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarFaces_h
#define volumicStarFaces_h

#include "Core/Common/Lanes.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <array>

namespace volumic
{
/** A vector for each neighbour of a vertex, kept so that four of them are worked on at once. */
class StarRow
{
public:
  VectorLanes At(int i) const ///< Those from i on.
  {
    return VectorLanes(
      Lanes::Load(this->X + i), Lanes::Load(this->Y + i), Lanes::Load(this->Z + i));
  }
  void Set(int i, const VectorLanes& four)
  {
    four.X.Store(this->X + i);
    four.Y.Store(this->Y + i);
    four.Z.Store(this->Z + i);
  }
  Vector operator[](int i) const { return Vector(this->X[i], this->Y[i], this->Z[i]); }

  /** Sets the four from i on to the first, so that after the last one the first follows. */
  void Close(int i)
  {
    const Vector first = (*this)[0];
    this->Set(i, AllLanes(first));
  }

private:
  static constexpr int Size = Ring::Capacity + 1 + Lanes::Count;
  alignas(16) float X[Size];
  alignas(16) float Y[Size];
  alignas(16) float Z[Size];
};

/**
 * A vertex and the places of its neighbours. Sets of these, or of the faces, are bits: face i lies
 * between the neighbours i and i + 1.
 */
struct StarRim
{
  StarRim(const SurfaceMesh& mesh, int v);

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
  /** Whether a vertex is one of both stars. */
  bool Shares(const StarRim& other) const;

  int Centre;
  int Count;
  int Item[Ring::Capacity + 1]; ///< The neighbours; four may be read from every fourth on.
  Vector Place;
  StarRow Rim; ///< Places of the neighbours; after the last follows the first.
};

/** A star with what tells its faces from those of others. */
struct StarFaces : StarRim
{
  StarFaces(const SurfaceMesh& mesh, int v);

  StarRow Low; ///< Of the faces' boxes.
  StarRow High;
  StarRow Normal; ///< Unit, of the faces.
};
}

#endif
