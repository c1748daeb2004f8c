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
 * The fields of all objects of a label map, stored in the bricks near their boundaries. A position
 * belongs to the object with the largest field value. The interface of two objects is the set of
 * positions with equal field values, so that objects cover space without gaps or overlaps. At voxel
 * centres each field has the correct sign, so that the fields reproduce the map. The background,
 * object 0, has a field as well.
 */
class InterfaceFields
{
public:
  /**
   * @param step       size of a voxel in computational space
   * @param progress   callback with the completed fraction, called on any thread. Returns false to
   *                   cancel; the fields are then incomplete.
   * @param isPeriodic whether the box in which voxels are counted is repeated periodically
   */
  InterfaceFields(const LabelBricks& bricks, const LabelFieldOptions& options,
    const std::array<double, 3>& step, Executor& executor,
    const std::function<bool(double fraction)>& progress, bool isPeriodic = false);

  const LabelBricks& Bricks() const { return this->Map; }
  const std::array<double, 3>& Step() const { return this->Lengths; }
  /** Return whether objects end at the sides of the box in which voxels are counted. */
  bool HaveBox() const { return !(this->Map.Inside() == VoxelBox::Of(this->Map.Map().Size())); }
  bool ArePeriodic() const { return this->IsPeriodic; }
  /** Return the voxel that stores the values of a voxel: another one if fields are periodic. */
  std::array<int, 3> SourceOf(std::array<int, 3> voxel) const
  {
    for (int axis = 0; axis < 3 && this->IsPeriodic; ++axis)
    {
      voxel[axis] = this->Map.Inside().Wrapped(voxel[axis], axis);
    }
    return voxel;
  }

  /** Return the field of an object at a voxel; +-LabelField::Far where no values are stored. */
  float At(int object, int i, int j, int k) const;

  /** Trilinear interpolation of a field, and its gradient in computational space. */
  struct Sample
  {
    float Value;
    Vector Gradient;
  };
  Sample Interpolate(int object, const Vector& position) const;
  float ValueAt(int object, const Vector& position) const
  {
    return this->Interpolate(object, position).Value;
  }

  /** Return half the difference of the fields of two objects, which is 0 on their interface. */
  Sample Between(int object, int other, const Vector& position) const
  {
    const Sample a = this->Interpolate(object, position);
    const Sample b = this->Interpolate(other, position);
    return { 0.5f * (a.Value - b.Value), (a.Gradient - b.Gradient) * 0.5f };
  }

  /**
   * Increase the absolute value of the field of an object at a voxel, and by half as much at the
   * face neighbours with the same label. No sign changes. Used at voxels that triangles cut off.
   */
  void Push(int object, const std::array<int, 3>& voxel, float by);

  /**
   * Add a constant to the interpolated field of an object. The sum of all shifts is clamped to
   * MostShift plus the tolerance of faces.
   */
  void Shift(int object, float by, float tolerance = 0.f)
  {
    float& shift = this->Shifts[static_cast<std::size_t>(object)];
    const float most = MostShift + tolerance;
    shift = std::clamp(shift + by, -most, most);
  }

private:
  static constexpr float MostShift = 3.f; ///< in the smallest voxel spacing
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
  /** Bricks of an object in a part of the map, and their values, x fastest. */
  struct Part
  {
    std::vector<std::size_t> Bricks;
    LargeVector<float> Values;
  };
  Part PartOf(const VoxelBox& within, const LabelField& field) const;
  /** Store the parts of all objects, sorted by brick and object. */
  void Join(std::vector<std::vector<Part>>& parts);
  /** Return the values of an object in a brick, x fastest; null: none are stored. */
  float* ValuesIn(std::size_t brick, int object) const;

  struct Brick
  {
    float* Values;
    LabelMap::Number Object;
  };

  const LabelBricks& Map;
  std::array<double, 3> Lengths;
  bool IsPeriodic;
  std::vector<std::size_t> First;         ///< first entry of each brick in BrickEntries
  std::vector<Brick> BrickEntries;        ///< sorted by brick and object
  std::vector<LargeVector<float>> Values; ///< values of all parts
  std::vector<float> Shifts;              ///< shift of each object
};
}

#endif
