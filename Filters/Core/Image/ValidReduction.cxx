// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ValidReduction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace volumic
{
namespace
{
/** Minimum weight of the valid voxels for a valid output voxel. */
constexpr double LeastWeight = 0.5;
}

template <typename T>
bool ReduceValidVoxels(const T* input, const LargeVector<std::uint8_t>& valid,
  const LevelGeometry& inputGeometry, typename RealOf<T>::Type* output,
  const LevelGeometry& outputGeometry, Executor& executor, const ProgressCallback& progress)
{
  using Real = typename RealOf<T>::Type;
  LargeVector<T> values(valid.size());
  std::transform(valid.begin(), valid.end(), input, values.begin(),
    [](std::uint8_t mark, T value) { return mark != 0 ? value : T(0); });
  const auto firstHalf = [&](double share) { return progress(0.5 * share); };
  const auto secondHalf = [&](double share) { return progress(0.5 + 0.5 * share); };
  if (!ReduceLevel(values.data(), inputGeometry, output, outputGeometry, executor, firstHalf))
  {
    return false;
  }
  values = LargeVector<T>();
  // Weights have the precision of the voxels. As bytes they would have single precision.
  using Mark = std::conditional_t<std::is_same_v<Real, double>, double, std::uint8_t>;
  const LargeVector<Mark> marks(valid.begin(), valid.end());
  LargeVector<Real> weights(static_cast<std::size_t>(outputGeometry.NumberOfVoxels()));
  if (!ReduceLevel(
        marks.data(), inputGeometry, weights.data(), outputGeometry, executor, secondHalf))
  {
    return false;
  }
  std::transform(weights.begin(), weights.end(), output, output,
    [](Real weight, Real sum) {
      return weight >= Real(LeastWeight) ? sum / weight : std::numeric_limits<Real>::quiet_NaN();
    });
  return true;
}

template <typename Real>
LargeVector<std::uint8_t> MarkNumbers(const Real* values, std::int64_t n)
{
  LargeVector<std::uint8_t> marks(static_cast<std::size_t>(n));
  std::transform(values, values + n, marks.begin(),
    [](Real value) { return static_cast<std::uint8_t>(std::isnan(value) ? 0 : 1); });
  return marks;
}

#define VOLUMIC_INSTANTIATE(T)                                                   \
  template bool ReduceValidVoxels<T>(const T*, const LargeVector<std::uint8_t>&, \
    const LevelGeometry&, RealOf<T>::Type*, const LevelGeometry&, Executor&,     \
    const ProgressCallback&);
VOLUMIC_FOR_EACH_SCALAR(VOLUMIC_INSTANTIATE)
#undef VOLUMIC_INSTANTIATE
template LargeVector<std::uint8_t> MarkNumbers<float>(const float*, std::int64_t);
template LargeVector<std::uint8_t> MarkNumbers<double>(const double*, std::int64_t);
}
