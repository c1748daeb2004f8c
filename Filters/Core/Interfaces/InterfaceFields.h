// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceFields_h
#define volumicInterfaceFields_h

#include "Core/Common/Executor.h"
#include "Core/Common/Vector.h"
#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelField.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * The fields of all objects of a label map, in the bricks about their boundaries. A place belongs
 * to the object whose field is the largest there, and the interface of two objects is where their
 * fields are the same: they cover space without gap or overlap, whatever the fields are. At the
 * centres of voxels that is what the map says, as each field has the right sign there.
 *
 * Object 0, what is about all others, is one of them.
 */
class InterfaceFields
{
public:
  /**
   * @param step       lengths of a voxel in the workspace
   * @param isPeriodic beyond the box in which voxels are counted its other end follows
   * @param goOn told the share that is done, on any thread; after false what there is is of no use
   */
  InterfaceFields(const LabelBricks& bricks, const LabelFieldOptions& options,
    const std::array<double, 3>& step, Executor& executor,
    const std::function<bool(double share)>& goOn, bool isPeriodic = false);

  const LabelBricks& Bricks() const { return this->Map; }
  const std::array<double, 3>& Step() const { return this->Lengths; }
  /** Whether objects end at the box in which voxels are counted, and not in what is about it. */
  bool HaveBox() const { return !(this->Map.Inside() == VoxelBox::Of(this->Map.Map().Size())); }
  bool ArePeriodic() const { return this->IsPeriodic; }
  /** That in the box whose values a voxel has: another one only where fields are periodic. */
  std::array<int, 3> SourceOf(std::array<int, 3> voxel) const
  {
    for (int axis = 0; axis < 3 && this->IsPeriodic; ++axis)
    {
      voxel[axis] = this->Map.Inside().Wrapped(voxel[axis], axis);
    }
    return voxel;
  }

  /** The field of an object at a voxel of the map; far from its boundary +-LabelField::Far. */
  float At(int object, int i, int j, int k) const;

  /** The field between the voxels, and its gradient by the lengths of the workspace. */
  struct Sample
  {
    float Value;
    Vector Gradient;
  };
  Sample Interpolate(int object, const Vector& place) const;
  float ValueAt(int object, const Vector& place) const
  {
    return this->Interpolate(object, place).Value;
  }

  /** Half of what one object's field is more than another one's: 0 on their interface. */
  Sample Between(int object, int other, const Vector& place) const
  {
    const Sample a = this->Interpolate(object, place);
    const Sample b = this->Interpolate(other, place);
    return { 0.5f * (a.Value - b.Value), (a.Gradient - b.Gradient) * 0.5f };
  }

  /**
   * Takes the field of an object further from 0 at a voxel, and half as much at those of the same
   * object as it beside it, so that no sign changes: where triangles have cut the voxel off.
   */
  void Push(int object, const std::array<int, 3>& voxel, float by);

  /**
   * Adds a number to the whole field of an object, between the voxels; all of these together stay
   * within MostShift, and what faces may be off.
   */
  void Shift(int object, float by, float tolerance = 0.f)
  {
    float& shift = this->Shifts[static_cast<std::size_t>(object)];
    const float most = MostShift + tolerance;
    shift = std::clamp(shift + by, -most, most);
  }

private:
  static constexpr float MostShift = 3.f; ///< smallest distances of voxels
  static constexpr int Side = LabelBricks::Side;
  static constexpr std::size_t VoxelsOfBrick = static_cast<std::size_t>(Side) * Side * Side;

  std::size_t NumberOfBrick(int i, int j, int k) const
  {
    return static_cast<std::size_t>(VoxelBox::Of(this->Map.Size()).NumberOf(i, j, k));
  }
  static std::size_t IndexInBrick(int i, int j, int k)
  {
    return static_cast<std::size_t>(((k % Side) * Side + j % Side) * Side + i % Side);
  }
  /** The bricks that a part of a map has of an object, and their values, x fastest. */
  struct Part
  {
    std::vector<std::size_t> Bricks;
    LargeVector<float> Values;
  };
  Part PartOf(const VoxelBox& within, const LabelField& field) const;
  /** Sorts the parts of each object by bricks. */
  void Join(std::vector<std::vector<Part>>& parts);
  /** The values of a brick, x fastest; null: it has none of this object. */
  float* ValuesIn(std::size_t brick, int object) const;

  struct Brick
  {
    float* Values;
    LabelMap::Number Object;
  };

  const LabelBricks& Map;
  std::array<double, 3> Lengths;
  bool IsPeriodic;
  std::vector<std::size_t> First;         ///< of each brick, in OfBricks
  std::vector<Brick> OfBricks;            ///< those of a brick sorted by object
  std::vector<LargeVector<float>> Values; ///< of all parts
  std::vector<float> Shifts;              ///< of each object
};
}

#endif
