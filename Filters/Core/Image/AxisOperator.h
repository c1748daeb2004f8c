// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAxisOperator_h
#define volumicAxisOperator_h

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Banded linear operator of eq. 5 along one axis: output voxel i is the sum over t of Weight(i, t)
 * times input voxel First(i) + t.
 *
 * The interpolation of V_h and the kernel (1 4 6 4 1)/16 are separable. The product of three
 * operators equals the sum over 125 x 8 voxels of eq. 5. The paper interpolates at each of the five
 * kernel positions; here both steps are combined in at most six weights, computed once for all
 * rows. Positions beyond the border take the nearest voxel.
 */
class AxisOperator
{
public:
  /** Five positions, at most a voxel apart, lie between six voxels. */
  static constexpr int MaximumNumberOfTaps = 6;

  /**
   * @param inputSize  M_h, voxels of level h along the axis
   * @param outputSize M_{h+1}
   * @param offset     distance between kernel positions, U_h / (mu/M_h), in voxels of level h, in
   *                   [0, 1]
   * @throws std::invalid_argument if a size is under 1 or the offset outside [0, 1].
   */
  AxisOperator(std::int64_t inputSize, std::int64_t outputSize, double offset);

  /** Return the number of weights of each output voxel, padded with zeros. */
  int NumberOfTaps() const { return this->Taps; }

  /** Return the first input voxel of an output voxel. */
  std::int64_t First(std::int64_t output) const { return this->FirstVoxel[output]; }

  /** Return the NumberOfTaps() weights of an output voxel. Their sum is 1. */
  const double* Weights(std::int64_t output) const { return &this->Weight[output * this->Taps]; }

private:
  int Taps = 0;
  std::vector<std::int64_t> FirstVoxel;
  std::vector<double> Weight;
};
}

#endif
