// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAxisOperator_h
#define volumicAxisOperator_h

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Equation 5 along one axis, as a banded linear operator: output voxel i is the sum over t of
 * Weight(i, t) times input voxel First(i) + t.
 *
 * The interpolation of V_h and the kernel (1 4 6 4 1)/16 both factor over the axes, so that the
 * product of three such operators equals the sum over 125 x 8 voxels of eq. 5. What we do
 * differently from the paper: it computes the five places and interpolates each of them; here both
 * steps are folded into at most six weights, computed once for all rows. Weights fall on the
 * nearest voxel where places lie past the border.
 */
class AxisOperator
{
public:
  /**
   * A place between two voxels touches both: five places at most a voxel apart touch six voxels.
   */
  static constexpr int MaximumNumberOfTaps = 6;

  /**
   * @param inputSize  M_h, voxels of level h along the axis
   * @param outputSize M_{h+1}
   * @param offset     distance of two places of the kernel, U_h / (mu/M_h), in voxels of level h,
   *                   in [0, 1]
   * @throws std::invalid_argument if a size is under 1 or the offset outside [0, 1].
   */
  AxisOperator(std::int64_t inputSize, std::int64_t outputSize, double offset);

  std::int64_t InputSize() const { return this->Input; }
  std::int64_t OutputSize() const { return static_cast<std::int64_t>(this->FirstVoxel.size()); }

  /** Number of weights of every output voxel (short ones are filled up with zeros). */
  int NumberOfTaps() const { return this->Taps; }

  /**
   * First input voxel of an output voxel; First(i) + NumberOfTaps() <= InputSize(). Grows with i.
   */
  std::int64_t First(std::int64_t output) const { return this->FirstVoxel[output]; }

  /** The weights of an output voxel, NumberOfTaps() of them; their sum is 1. */
  const double* Weights(std::int64_t output) const { return &this->Weight[output * this->Taps]; }

private:
  std::int64_t Input;
  int Taps = 0;
  std::vector<std::int64_t> FirstVoxel;
  std::vector<double> Weight;
};
}

#endif
