// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSides_h
#define volumicLabelSides_h

#include "Core/Labels/LabelField.h"
#include "Core/Labels/LabelMap.h"

namespace volumic
{
/** Which voxels are of an object, and whether its field says so. Voxels may be beyond the map. */
class LabelSides
{
public:
  /** The map must outlive it. */
  LabelSides(const LabelMap& map, int object)
    : Map(&map), Object(static_cast<LabelMap::Number>(object))
  {
  }

  bool IsObject(int i, int j, int k) const { return this->Map->At(i, j, k) == this->Object; }
  /** The side of a voxel: 1 in the object, -1 elsewhere. */
  float Of(int i, int j, int k) const { return this->IsObject(i, j, k) ? 1.f : -1.f; }

  /** Writes for each of `count` voxels along x: 1 in the object, 0 elsewhere. */
  void CopyMembership(int i, int j, int k, int count, float* values) const;

  /** Whether the field has the right sign there; beyond its box it has. */
  bool IsRight(const LabelField& field, int i, int j, int k) const;

  /** Whether it has the wrong one, and so it has at all voxels of the same side beside this one. */
  bool IsLost(const LabelField& field, int i, int j, int k) const;

  /** Whether both neighbours along an axis are on the other side. */
  bool IsThin(int i, int j, int k) const;

private:
  const LabelMap* Map;
  LabelMap::Number Object;
};
}

#endif
