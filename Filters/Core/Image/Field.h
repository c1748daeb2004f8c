// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicField_h
#define volumicField_h

#include "Core/Common/Executor.h"
#include "Core/Common/Vector.h"
#include "Core/Image/FieldOptions.h"
#include "Core/Image/ImageMargin.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/VoxelBox.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * Continuous field of a level (section 4.1 of the paper). Value is the image minus the iso-value,
 * negated for dark objects, so it is positive inside the object. It is interpolated trilinearly.
 * The gradient is the trilinear interpolation of central differences, not the derivative of Value.
 *
 * Outside the image:
 * - Border::Background: background voxels, so the field falls within one voxel. Their value is the
 *   lowest Value of the image, or minus the highest one if that is lower.
 * - Border::Replicate: the nearest voxel up to ImageMargin::Width, then background after
 *   ImageMargin::Ramp.
 */
class Field
{
public:
  struct Sample
  {
    float Value;
    Vector Gradient; ///< of Value, per length in the computational space
  };

  /** @throws std::invalid_argument for an image without voxels. */
  Field(const LevelImage& image, const FieldOptions& options, Executor& executor);

  float ValueAt(const Vector& position) const;
  /** Return the image minus the iso-value, also for dark objects. */
  float ResidualAt(const Vector& position) const { return this->Sign * this->ValueAt(position); }
  Sample At(const Vector& position) const;

  /** Return the extremes of Value. There is no object if the highest one is not positive. */
  float Highest() const { return this->HighestValue; }
  float Lowest() const { return this->LowestValue; }

  /**
   * Return the mean absolute slope between neighbouring voxels on different sides of the iso-value,
   * per length in the computational space.
   */
  float TypicalSlope() const { return this->Slope; }

  /** Return the length of the gradient, at least 0.15 TypicalSlope(): a safe divisor. */
  float SlopeOf(const Sample& sample) const;

  /**
   * Return the length of a Newton step along a unit normal onto the isosurface, in
   * [-longest, longest]; 0 if the normal deviates much from the gradient.
   */
  float StepToIso(const Sample& sample, const Vector& normal, float longest) const;

  /** Return whether the estimated distance to the isosurface exceeds `distance`. */
  bool IsOff(const Vector& position, float distance) const
  {
    const Sample sample = this->At(position);
    return std::abs(sample.Value) > distance * this->SlopeOf(sample);
  }

  const LevelImage& Image() const { return this->Level; }
  const ImageMargin& Margin() const { return this->Around; }
  /** Return Value at a voxel of the image. */
  float Voxel(int i, int j, int k) const
  {
    return this->Sign * (this->Level.Values[this->Offset(i, j, k)] - this->Iso);
  }
  /** Get Value at `count` voxels of a row from (i, j, k) on, all in the image. */
  void Row(int i, int j, int k, int count, float* values) const;

private:
  struct Cell
  {
    int I, J, K;
    float X, Y, Z;
  };
  std::ptrdiff_t Offset(int i, int j, int k) const
  {
    return i +
      static_cast<std::ptrdiff_t>(this->Level.Size[0]) *
      (j + static_cast<std::ptrdiff_t>(this->Level.Size[1]) * k);
  }
  Cell Locate(const Vector& position) const;
  /** Return an entry of Level.Values, also outside the image. */
  template <typename Voxels>
  float Fetch(const Voxels& voxels, int i, int j, int k) const;
  /** Return the sample in the cell with first voxel `first`, given the strides of rows, slices. */
  template <typename Voxels>
  Sample Interpolated(const Cell& cell, const Voxels& voxels, std::ptrdiff_t first,
    std::ptrdiff_t row, std::ptrdiff_t slice) const;
  Sample Faded(const Vector& position, const Sample& sample) const;
  std::array<float, 2> FindExtremes(Executor& executor) const;
  void MeasureRange(const std::array<float, 2>& extremes);
  void MeasureSlope(Executor& executor);

  LevelImage Level;
  ImageMargin Around;
  float Iso = 0; ///< iso-value minus Base of the image, as Level.Values
  float Sign = 1;
  float Inverse[3] = { 1, 1, 1 };
  float Outside = 0; ///< value of background voxels
  float HighestValue = 0;
  float LowestValue = 0;
  float Slope = 1;
  bool Replicate = false;
};
}

#endif
