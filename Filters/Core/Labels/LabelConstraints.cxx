// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelConstraints.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Standard deviations of the two Gaussians of the kernel, in the smallest voxel spacing. */
constexpr double WideSigma = 1.5;
constexpr double NarrowSigma = 0.6;
/** Weight of the narrow Gaussian. It keeps the problem well-posed if signs alternate by voxel. */
constexpr double NarrowWeight = 0.3;
constexpr int MostSweeps = 40;
constexpr float Tolerance = 0.01f; ///< of a constraint

/** Kernel at a voxel, x fastest. */
class Kernel
{
public:
  explicit Kernel(const std::array<double, 3>& spacing)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Reach[axis] =
        std::clamp(static_cast<int>(3. * WideSigma / spacing[axis]), 1, ConstraintReach);
    }
    const std::array<int, 3>& r = this->Reach;
    VoxelBox{ { -r[0], -r[1], -r[2] }, { r[0] + 1, r[1] + 1, r[2] + 1 } }.ForVoxels(
      [&](int i, int j, int k)
      {
        const double x = i * spacing[0];
        const double y = j * spacing[1];
        const double z = k * spacing[2];
        const double square = x * x + y * y + z * z;
        // A product of positive definite kernels is positive definite; a truncated kernel is not.
        const double taper = this->Taper(0, i) * this->Taper(1, j) * this->Taper(2, k);
        const double wide = std::exp(-0.5 * square / (WideSigma * WideSigma));
        const double narrow = std::exp(-0.5 * square / (NarrowSigma * NarrowSigma));
        this->Values.push_back(
          static_cast<float>(taper * ((1. - NarrowWeight) * wide + NarrowWeight * narrow)));
      });
  }

  /** Add the kernel, times `factor`, to the field within its box. */
  void AddTo(LabelField& field, std::int64_t index, float factor) const
  {
    const std::array<int, 3> size = field.Box.Size();
    const int x = static_cast<int>(index % size[0]);
    const int y = static_cast<int>(index / size[0] % size[1]);
    const int z = static_cast<int>(index / size[0] / size[1]);
    const int first = std::max(-this->Reach[0], -x);
    const int last = std::min(this->Reach[0], size[0] - 1 - x);
    const float* row = this->Values.data();
    for (int k = -this->Reach[2]; k <= this->Reach[2]; ++k)
    {
      for (int j = -this->Reach[1]; j <= this->Reach[1]; ++j)
      {
        if (y + j >= 0 && y + j < size[1] && z + k >= 0 && z + k < size[2])
        {
          float* to =
            field.Values.data() + index + size[0] * (j + static_cast<std::int64_t>(size[1]) * k);
          for (int i = first; i <= last; ++i)
          {
            to[i] += factor * row[i + this->Reach[0]];
          }
        }
        row += 2 * this->Reach[0] + 1;
      }
    }
  }

private:
  double Taper(int axis, int voxels) const
  {
    return 1. - std::abs(voxels) / (this->Reach[axis] + 1.);
  }

  std::array<int, 3> Reach;
  std::vector<float> Values; ///< 1 at the middle
};
}

void ConstrainToLabels(LabelField& field, const std::array<double, 3>& spacing,
  const std::vector<VoxelConstraint>& constraints)
{
  const Kernel kernel(spacing);
  std::vector<float> multipliers(constraints.size(), 0.f);
  bool areMet = false;
  for (int sweep = 0; sweep < MostSweeps && !areMet; ++sweep)
  {
    areMet = true;
    for (std::size_t c = 0; c < constraints.size(); ++c)
    {
      const VoxelConstraint& constraint = constraints[c];
      const auto index = static_cast<std::size_t>(constraint.Index);
      const float deficit = constraint.Margin - constraint.Side * field.Values[index];
      float& multiplier = multipliers[c];
      const float change = std::max(deficit, -multiplier);
      if (change > Tolerance || change < -Tolerance)
      {
        multiplier += change;
        kernel.AddTo(field, constraint.Index, constraint.Side * change);
        areMet = false;
      }
    }
  }
}
}
