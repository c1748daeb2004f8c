// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/AxisOperator.h"
#include "TestPrelude.h"

using volumic::AxisOperator;

namespace
{
struct Case
{
  std::int64_t Input;
  double Factor;
  double Offset;

  std::int64_t Output() const
  {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(Input / Factor)));
  }
};

const std::vector<Case> Cases = { { 256, std::sqrt(3.), 1.0 }, { 147, std::sqrt(3.), 0.99 },
  { 108, std::sqrt(3.), 0.4 }, { 31, 1.2, 1.0 }, { 40, 1.9, 0.1 }, { 7, 1.99, 1.0 },
  { 2, 1.5, 1.0 }, { 1, 1.5, 0.0 } };

double Apply(const AxisOperator& axis, const std::vector<double>& input, std::int64_t i)
{
  double sum = 0.0;
  for (int t = 0; t < axis.NumberOfTaps(); ++t)
  {
    sum += axis.Weights(i)[t] * input[axis.First(i) + t];
  }
  return sum;
}

/** Equation 5 along one axis, word by word. */
double DirectSum(const std::vector<double>& input, double place, double offset)
{
  const double kernel[5] = { 1, 4, 6, 4, 1 };
  const double last = static_cast<double>(input.size() - 1);
  double sum = 0.0;
  for (int m = -2; m <= 2; ++m)
  {
    const double p = std::min(std::max(place + m * offset, 0.0), last);
    const auto lower = static_cast<std::size_t>(p);
    const std::size_t upper = std::min(lower + 1, input.size() - 1);
    const double share = p - static_cast<double>(lower);
    sum += kernel[m + 2] / 16. * ((1 - share) * input[lower] + share * input[upper]);
  }
  return sum;
}
}

TEST(AxisOperator, EqualsTheDirectSum)
{
  for (const Case& c : Cases)
  {
    const AxisOperator axis(c.Input, c.Output(), c.Offset);
    ASSERT_LE(axis.NumberOfTaps(), AxisOperator::MaximumNumberOfTaps);
    std::vector<double> input(c.Input);
    std::uint32_t state = 1;
    for (double& value : input)
    {
      state = state * 1664525u + 1013904223u;
      value = state / 4294967296.0;
    }
    for (std::int64_t i = 0; i < c.Output(); ++i)
    {
      const double place = static_cast<double>(i) * c.Input / c.Output();
      ASSERT_GE(axis.First(i), i == 0 ? 0 : axis.First(i - 1));
      ASSERT_LE(axis.First(i) + axis.NumberOfTaps(), c.Input);
      EXPECT_NEAR(Apply(axis, input, i), DirectSum(input, place, c.Offset), 1e-12)
        << c.Input << " voxels, T = " << c.Factor << ", output " << i;
    }
  }
}

TEST(AxisOperator, RefusesImpossibleSizesAndOffsets)
{
  EXPECT_THROW(AxisOperator(0, 1, 1.0), std::invalid_argument);
  EXPECT_THROW(AxisOperator(4, 0, 1.0), std::invalid_argument);
  EXPECT_THROW(AxisOperator(4, 2, 1.1), std::invalid_argument);
  EXPECT_THROW(AxisOperator(4, 2, -0.1), std::invalid_argument);
  EXPECT_THROW(AxisOperator(4, 2, std::nan("")), std::invalid_argument);
}
