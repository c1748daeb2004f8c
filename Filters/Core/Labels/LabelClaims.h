// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelClaims_h
#define volumicLabelClaims_h

#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelField.h"

#include <mutex>
#include <vector>

namespace volumic
{
/**
 * Where three objects meet (0 is one of them), which of them claim each voxel most, by their
 * fields. With fewer the field of one is the other's times -1, and nothing has to be settled.
 */
class LabelClaims
{
public:
  /** The bricks must outlive it. */
  explicit LabelClaims(const LabelBricks& bricks);

  /** Once for each object but 0, in any order, on any thread. */
  void Add(int object, const LabelField& field);

  /**
   * Once all have been added: where another object's field is d', the field d becomes the smaller
   * one of d and (d - d')/2. Then fields of two objects add up to 0 at most everywhere, so that
   * their insides have nothing in common; signs at voxel centres stay.
   */
  void Settle(int object, LabelField& field) const;

private:
  struct Claims
  {
    float Most = -LabelField::Far;
    float Second = -LabelField::Far;
    LabelMap::Number Claimant = 0; ///< the object that claims most
  };
  template <typename Visitor>
  void ForVoxels(const LabelField& field, Visitor&& visit) const;

  const LabelBricks* Bricks;
  std::vector<int> Places; ///< of the claims of each brick, -1: none
  std::vector<Claims> All; ///< one brick after the other
  std::mutex Mutex;
};
}

#endif
