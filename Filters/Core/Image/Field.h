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
 * The continuous field of a level (the paper's section 4.1), as the surface wants it: Value is the
 * image minus the iso-value, with the sign changed for dark objects, so that it is positive on
 * the object's side. Trilinear between voxels; the gradient is the trilinear interpolation of
 * the discrete gradient (central differences), not the derivative of the interpolant.
 *
 * Outside the image the voxels count as background (the extreme value of the image away from the
 * object, or as far below the iso-value as the object is above it, whichever is the stronger), so
 * the field ramps over one voxel; or, for Border::Replicate, as the nearest voxel as far as
 * ImageMargin::Width, and from there on as background, ramping over ImageMargin::Ramp.
 */
class Field
{
public:
  struct Sample
  {
    float Value;
    Vector Gradient; ///< Of Value, per unit of length of the workspace.
  };

  /** @throws std::invalid_argument for an image without voxels. */
  Field(const LevelImage& image, const FieldOptions& options, Executor& executor);

  float ValueAt(const Vector& position) const;
  /** The image minus the iso-value, whichever side the object is on. */
  float ResidualAt(const Vector& position) const { return this->Sign * this->ValueAt(position); }
  Sample At(const Vector& position) const;

  /** Extremes of Value in the image; where the highest is not positive there is no object. */
  float Highest() const { return this->HighestValue; }
  float Lowest() const { return this->LowestValue; }

  /**
   * Mean absolute slope of the pairs of neighbouring voxels between which the iso-value lies: the
   * steepness that a typical piece of the searched surface has. Value per workspace length.
   */
  float TypicalSlope() const { return this->Slope; }

  /** Length of the gradient, but at least 0.15 TypicalSlope(): safe to divide by on plateaus. */
  float SlopeOf(const Sample& sample) const;

  /**
   * Newton's step along a unit normal onto the isopotential, from where the sample is: its length,
   * at most `longest`; 0 where the normal says little about the gradient, as a step would only do
   * harm there.
   */
  float StepToIso(const Sample& sample, const Vector& normal, float longest) const;

  /** Whether a place is further off the isopotential than this length, as its slope there tells. */
  bool IsOff(const Vector& position, float distance) const
  {
    const Sample sample = this->At(position);
    return std::abs(sample.Value) > distance * this->SlopeOf(sample);
  }

  /** What the image counts as outside its voxels, with Border::Background. */
  float Background() const { return this->Outside; }

  const LevelImage& Image() const { return this->Level; }
  const ImageMargin& Margin() const { return this->Around; }
  /** Value at a voxel inside the image. */
  float Voxel(int i, int j, int k) const
  {
    return this->Sign * (this->Level.Values[this->Offset(i, j, k)] - this->Iso);
  }
  /** Values at so many voxels of a row from (i, j, k) on, all inside the image: for many voxels. */
  void Row(int i, int j, int k, int count, float* values) const;

private:
  struct Cell
  {
    int I, J, K;
    float X, Y, Z;
  };
  std::ptrdiff_t Offset(int i, int j, int k) const
  {
    return i + static_cast<std::ptrdiff_t>(this->Level.Size[0]) *
      (j + static_cast<std::ptrdiff_t>(this->Level.Size[1]) * k);
  }
  Cell Locate(const Vector& position) const;
  /** As Level.Values, also outside the image. */
  template <typename Voxels>
  float Fetch(const Voxels& voxels, int i, int j, int k) const;
  /** The sample in the cell of voxels whose first one is `first`, rows and slices apart. */
  template <typename Voxels>
  Sample Interpolated(const Cell& cell, const Voxels& voxels, std::ptrdiff_t first,
    std::ptrdiff_t row, std::ptrdiff_t slice) const;
  Sample Faded(const Vector& position, const Sample& sample) const;
  std::array<float, 2> FindExtremes(Executor& executor) const;
  void MeasureRange(const std::array<float, 2>& extremes);
  void MeasureSlope(Executor& executor);

  LevelImage Level;
  ImageMargin Around;
  float Iso = 0; ///< The iso-value less the image's Base, as Level.Values are.
  float Sign = 1;
  float Inverse[3] = { 1, 1, 1 };
  float Outside = 0; ///< Of the background, as the voxels.
  float HighestValue = 0;
  float LowestValue = 0;
  float Slope = 1;
  bool Replicate = false;
};
}

#endif
