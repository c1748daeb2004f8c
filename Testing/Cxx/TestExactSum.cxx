// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ExactSum.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
ExactSum SumOf(const std::vector<double>& terms, std::size_t begin, std::size_t end)
{
  ExactSum sum;
  for (std::size_t i = begin; i < end; ++i)
  {
    sum.Add(terms[i]);
  }
  return sum;
}
}

TEST(ExactSum, DoesNotDependOnTheOrder)
{
  std::vector<double> terms;
  double low = 0.;
  for (int i = 0; i < 20000; ++i)
  {
    terms.push_back(std::sin(i * 1.7) * std::pow(10., i % 13 - 3));
    low += terms.back();
  }
  const double expected = SumOf(terms, 0, terms.size()).Value();
  EXPECT_NEAR(expected, low, 1e-3);
  std::reverse(terms.begin(), terms.end());
  EXPECT_EQ(SumOf(terms, 0, terms.size()).Value(), expected);
  double plain = 0.;
  for (const double term : terms)
  {
    plain += term;
  }
  EXPECT_NE(plain, low) << "as sums of doubles do";
  for (const std::size_t cut : { 1u, 777u, 19999u })
  {
    ExactSum parts = SumOf(terms, cut, terms.size());
    parts.Add(SumOf(terms, 0, cut));
    EXPECT_EQ(parts.Value(), expected);
  }
}

TEST(ExactSum, IsExactForWhatItResolves)
{
  const double least = std::pow(2., -40);
  ExactSum sum;
  for (const double term : { 3e12, least, -3e12, least, -1.25 })
  {
    sum.Add(term);
  }
  EXPECT_EQ(sum.Value(), 2. * least - 1.25);
  EXPECT_EQ(ExactSum().Value(), 0.);
}
