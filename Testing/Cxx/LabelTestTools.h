// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelTestTools_h
#define volumicLabelTestTools_h

#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelField.h"
#include "Core/Labels/LabelMap.h"
#include "ForVoxels.h"
#include "TestPrelude.h"

namespace volumic
{
/** Return a map of the objects objectAt(i, j, k). */
inline LabelMap MakeLabelMap(
  const std::array<int, 3>& size, int objects, const std::function<int(int, int, int)>& objectAt)
{
  LabelMap map(size);
  map.NumberOfObjects = objects;
  ForVoxels(size,
    [&](int i, int j, int k)
    { map.Set(i, j, k, static_cast<LabelMap::Number>(objectAt(i, j, k))); });
  return map;
}

/** Return a map with a pseudo-random object from 0 to `objects` at each voxel. */
inline LabelMap NoisyLabelMap(const std::array<int, 3>& size, int objects, unsigned seed)
{
  return MakeLabelMap(size, objects,
    [&](int, int, int)
    {
      seed = seed * 1664525u + 1013904223u;
      return static_cast<int>((seed >> 16) % (static_cast<unsigned>(objects) + 1));
    });
}

inline float ValueAt(const LabelField& field, int i, int j, int k)
{
  return field.Values[static_cast<std::size_t>(field.Box.NumberOf(i, j, k))];
}

/** Call visit(i, j, k, value) for each voxel of the field, also beyond the map. */
template <typename Visitor>
void ForVoxelsOf(const LabelField& field, Visitor&& visit)
{
  ForBox(field.Box.First, field.Box.End,
    [&](int i, int j, int k) { visit(i, j, k, ValueAt(field, i, j, k)); });
}
}

#endif
