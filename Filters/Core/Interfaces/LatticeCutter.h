// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLatticeCutter_h
#define volumicLatticeCutter_h

#include "Core/Common/Executor.h"
#include "Core/Common/Lattice.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Labels/LabelMap.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace volumic
{
/** Of the lattice; at the sides of a box one odd, the middle of an edge that they cut. */
struct LatticeSite
{
  LatticePoint At;
  LabelMap::Number Object;
};

/** The corners of a tetrahedron, and which of them are of one object. */
struct Tetrahedron
{
  std::array<LatticeSite, 4> Corner;
  std::array<int, 4> Group = { 0, 0, 0, 0 }; ///< of each corner, the objects numbered from 0
  int Groups = 0;

  void FindGroups()
  {
    this->Groups = 0;
    for (int c = 0; c < 4; ++c)
    {
      int same = 0;
      while (same < c && this->Corner[same].Object != this->Corner[c].Object)
      {
        ++same;
      }
      this->Group[c] = same < c ? this->Group[same] : this->Groups++;
    }
  }
};

/**
 * Cuts the tetrahedra of the lattice. The sides of a box are half a voxel from its outermost
 * voxels: with a pitch of 1 they lead through middles of cubes, and halve the tetrahedra that they
 * cut. The triangles of the lattice that are so in the sides are cut, too, between the objects in
 * them.
 */
class LatticeCutter
{
public:
  /** @param pitch along each axis, in voxels, 1 or 2; 1 where objects end at a box */
  LatticeCutter(const InterfaceFields& fields, const std::array<int, 3>& pitch)
    : Fields(fields), Map(fields.Bricks().Map()), Pitch(pitch), Box(fields.Bricks().Inside())
  {
    const bool hasBox = fields.HaveBox();
    this->Mesh.FirstSide = hasBox ? this->Map.NumberOfObjects + 1 : this->Mesh.FirstSide;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::array<int, 2> ends = { this->Box.First[axis], this->Box.End[axis] };
      for (int end = 0; end < 2 && hasBox; ++end)
      {
        this->Mesh.Planes[2 * axis + end] =
          static_cast<float>(fields.Step()[axis] * (ends[end] - 0.5));
      }
      this->Corners[axis] = (this->Map.Size()[axis] - 1) / pitch[axis] + 1;
    }
    this->OfMiddles =
      LabelMap({ this->Corners[0] - 1, this->Corners[1] - 1, this->Corners[2] - 1 });
  }

  /** Has voxels be of the object whose field is the largest there. */
  void FollowFields(Executor& executor);
  /**
   * Where an edge of the lattice passes over a voxel of a third object, one of its ends, the one
   * less deep in its object, becomes of that: so thin gaps are not bridged. After FollowFields().
   */
  void KeepGaps();
  void FindMiddles(Executor& executor);
  void CutBrick(int i, int j, int k);
  /** Whether a side of the box is in a brick, or beside it. */
  bool HasSides(int i, int j, int k) const;
  InterfaceMesh Take();

private:
  using Number = LabelMap::Number;

  /** Calls visit(i, j, k) for those of a box that are in bricks with interfaces, in their order. */
  template <typename Visitor>
  void ForVoxelsAtInterfaces(const VoxelBox& box, Visitor&& visit) const
  {
    constexpr int side = LabelBricks::Side;
    for (int k = box.First[2]; k < box.End[2]; ++k)
    {
      for (int j = box.First[1]; j < box.End[1]; ++j)
      {
        for (int brick = box.First[0] / side; brick * side < box.End[0]; ++brick)
        {
          if (this->Fields.HasInterfaces(brick, j / side, k / side))
          {
            const int end = std::min((brick + 1) * side, box.End[0]);
            for (int i = std::max(brick * side, box.First[0]); i < end; ++i)
            {
              visit(i, j, k);
            }
          }
        }
      }
    }
  }
  /** The end of an edge that may be of another object: not the last one of its own about it. */
  bool MayChange(const std::array<int, 3>& voxel) const;
  void KeepGapAt(const std::array<int, 3>& voxel, int axis);
  /** That whose field is the largest at a site, of those of the voxels about it. */
  Number ObjectBetween(const std::array<int, 3>& halves) const;
  Number ObjectOf(const std::array<int, 3>& voxel) const;
  /** Calls visit(i, j, k) for the voxel at a site, or the two, four or eight about it. */
  template <typename Visitor>
  void ForVoxels(const std::array<int, 3>& halves, Visitor&& visit) const
  {
    std::array<int, 3> first;
    std::array<int, 3> last;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int twice = this->Pitch[axis] * halves[axis];
      first[axis] = twice >> 1;
      last[axis] = first[axis] + (twice & 1);
    }
    for (int k = first[2]; k <= last[2]; ++k)
    {
      for (int j = first[1]; j <= last[1]; ++j)
      {
        for (int i = first[0]; i <= last[0]; ++i)
        {
          visit(i, j, k);
        }
      }
    }
  }
  LatticeSite SiteAt(const std::array<int, 3>& halves) const;
  /** Whether there is an edge along an axis, from a cube's corner on, in the box or into it. */
  bool IsInBox(const std::array<int, 3>& cube, int axis) const;
  void CutAbout(const std::array<int, 3>& cube);
  /** A triangle in a side of the box. @param inside the fourth corner of its tetrahedron */
  void CutSide(const std::array<LatticeSite, 3>& corners, const LatticeSite& inside, int axis);
  void Cut(const Tetrahedron& cell);
  void CutInTwo(const Tetrahedron& cell);
  void CutInMore(const Tetrahedron& cell);
  /** The field of an object at a site, from the voxels about it. */
  float ValueAt(const std::array<int, 3>& halves, int object) const;
  Vector PlaceOf(const LatticeSite& site) const;
  /** What of an edge is before its vertex. @param from earlier than the other one */
  float ShareOf(const LatticeSite& from, const LatticeSite& to) const;
  int VertexAt(const LatticeSite& site);
  int VertexOn(const LatticeSite& a, const LatticeSite& b);
  int VertexOn(const LatticeSite& a, const LatticeSite& b, const LatticeSite& c);
  /** A place between these, exactly in the side of the box in which all of them are. */
  Vector InSidesOf(const std::array<const LatticeSite*, 3>& sites, Vector place) const;
  /** A triangle between the objects of two sites, which are on either side of it. */
  void AddTriangle(
    const std::array<int, 3>& vertices, const LatticeSite& behind, const LatticeSite& front);

  const InterfaceFields& Fields;
  LabelMap Map;
  std::array<int, 3> Pitch;
  VoxelBox Box;               ///< in which all objects end
  std::array<int, 3> Corners; ///< of cubes, along each axis
  LabelMap OfMiddles;         ///< of cubes
  std::unordered_map<std::uint64_t, int> OnEdge; ///< by LatticeKey()
  std::unordered_map<std::uint64_t, int> OnFace;
  InterfaceMesh Mesh;
};
}

#endif
