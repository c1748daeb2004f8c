// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLatticeCutter_h
#define volumicLatticeCutter_h

#include "Core/Common/Executor.h"
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
/**
 * A point of the lattice, in halves of its pitch: all even, a corner of a cube, or all odd, the
 * middle of one.
 */
struct LatticeSite
{
  std::array<int, 3> At;
  LabelMap::Number Object;
};

struct Tetrahedron;

/** Cuts the tetrahedra of the lattice. */
class LatticeCutter
{
public:
  /** @param pitch along each axis, in voxels, 1 or 2 */
  LatticeCutter(const InterfaceFields& fields, const std::array<int, 3>& pitch)
    : Fields(fields), Map(fields.Bricks().Map()), Pitch(pitch)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Corners[axis] = (this->Map.Size[axis] - 1) / pitch[axis] + 1;
      this->Middles.End[axis] = this->Corners[axis] - 1;
    }
  }

  /** Has voxels be of the object whose field is the largest there. */
  void FollowFields(Executor& executor);
  /**
   * Where an edge of the lattice passes over a voxel of a third object, one of its ends, the one less
   * deep in its object, becomes of that: so thin gaps are not bridged. After FollowFields().
   */
  void KeepGaps();
  void FindMiddles(Executor& executor);
  void CutBrick(int i, int j, int k);
  InterfaceMesh Take()
  {
    this->Mesh.FindStrata();
    return std::move(this->Mesh);
  }

private:
  using Number = LabelMap::Number;
  using Key = std::uint64_t;

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
  void CutAbout(const std::array<int, 3>& cube);
  void Cut(const Tetrahedron& cell);
  void CutInTwo(const Tetrahedron& cell);
  void CutInMore(const Tetrahedron& cell);
  /** The field of an object at a site, from the voxels about it. */
  float ValueAt(const std::array<int, 3>& halves, int object) const;
  Vector PlaceOf(const LatticeSite& site) const;
  Key KeyOf(const LatticeSite& site) const;
  int VertexOn(const LatticeSite& a, const LatticeSite& b);
  int VertexOn(const LatticeSite& a, const LatticeSite& b, const LatticeSite& c);
  /** A triangle between the objects of two sites, which are on either side of it. */
  void AddTriangle(
    const std::array<int, 3>& vertices, const LatticeSite& behind, const LatticeSite& front);

  const InterfaceFields& Fields;
  LabelMap Map;
  std::array<int, 3> Pitch;
  std::array<int, 3> Corners; ///< of cubes, along each axis
  VoxelBox Middles;           ///< of cubes
  std::vector<Number> ObjectOfMiddle;
  std::unordered_map<Key, int> OnEdge;
  std::unordered_map<Key, int> OnFace;
  InterfaceMesh Mesh;
};
}

#endif
