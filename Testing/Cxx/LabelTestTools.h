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

/** Return pseudo-random bits, and change the seed. */
inline unsigned RandomBits(unsigned& seed)
{
  seed = seed * 1664525u + 1013904223u;
  return seed >> 8;
}

/** Return a pseudo-random number from 0 to 1. */
inline double RandomShare(unsigned& seed)
{
  return static_cast<double>(RandomBits(seed)) / (1u << 24);
}

/** Return a map with a pseudo-random object from 0 to `objects` at each voxel. */
inline LabelMap NoisyLabelMap(const std::array<int, 3>& size, int objects, unsigned seed)
{
  return MakeLabelMap(size, objects,
    [&](int, int, int)
    { return static_cast<int>((RandomBits(seed) >> 8) % (static_cast<unsigned>(objects) + 1)); });
}

inline float ValueAt(const LabelField& field, int i, int j, int k)
{
  return field.Values[static_cast<std::size_t>(field.Box.NumberOf(i, j, k))];
}
}

#endif
