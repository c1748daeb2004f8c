// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What is computed four at a time: the same bits as one at a time.
#include "Core/Common/Lanes.h"
#include "Core/Surface/NormalCone.h"
#include "Core/Surface/StarShape.h"
#include "Core/Surface/SurfaceState.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
/** Numbers in [-1, 1), the same in each run. */
class Numbers
{
public:
  float Next()
  {
    this->State = this->State * 1664525u + 1013904223u;
    return static_cast<float>(this->State >> 8) / (1 << 23) - 1.f;
  }
  Vector NextVector()
  {
    const float x = this->Next();
    const float y = this->Next();
    return Vector(x, y, this->Next());
  }

private:
  std::uint32_t State = 1;
};

float LaneOf(const Lanes& lanes, int i)
{
  float four[Lanes::Count];
  lanes.Store(four);
  return four[i];
}

}

TEST(Lanes, ComputeWhatOneFloatDoes)
{
  Numbers numbers;
  for (int round = 0; round < 100; ++round)
  {
    float a[4];
    float b[4];
    for (int i = 0; i < 4; ++i)
    {
      a[i] = numbers.Next();
      b[i] = i == round % 7 ? a[i] : numbers.Next();
    }
    const Lanes x = Lanes::Load(a);
    const Lanes y = Lanes::Load(b);
    const unsigned less = LessBits(x, y);
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(LaneOf(x + y, i), a[i] + b[i]);
      EXPECT_EQ(LaneOf(x - y, i), a[i] - b[i]);
      EXPECT_EQ(LaneOf(x * y, i), a[i] * b[i]);
      EXPECT_EQ(LaneOf(x / y, i), a[i] / b[i]);
      EXPECT_EQ(LaneOf(Minimum(x, y), i), std::min(a[i], b[i]));
      EXPECT_EQ(LaneOf(Maximum(x, y), i), std::max(a[i], b[i]));
      EXPECT_EQ(LaneOf(SquareRoot(x * x), i), std::sqrt(a[i] * a[i]));
      EXPECT_EQ(LaneOf(WhereLess(x, y, x), i), a[i] < b[i] ? a[i] : 0.f);
      EXPECT_EQ(less >> i & 1, a[i] < b[i] ? 1u : 0u);
    }
    EXPECT_EQ(LeastOf(x), *std::min_element(a, a + 4));
    EXPECT_EQ(GreatestOf(x), *std::max_element(a, a + 4));
  }
}
