// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Core/Surface/RemainingContacts.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
/** Two balls of radius 4 beside (16, 16, 16) along x, with a gap between their nearest vertices. */
struct TwoBalls : Bench
{
  explicit TwoBalls(double gap) : TwoBalls(Surface(gap)) {}
  explicit TwoBalls(const IndexedSurface& surface) : Bench(surface) {}

  static IndexedSurface Surface(double gap)
  {
    IndexedSurface ball = DividedIcosahedron({ 0, 0, 0 }, 4, 1.6);
    const double end = (*std::max_element(ball.Points.begin(), ball.Points.end()))[0];
    for (Point& p : ball.Points)
    {
      p = { p[0] - end - gap / 2 + 16, p[1] + 16, p[2] + 16 };
    }
    IndexedSurface mirrored = InsideOut(ball);
    for (Point& p : mirrored.Points)
    {
      p[0] = 32 - p[0];
    }
    AddSurface(ball, mirrored);
    return ball;
  }

  RemainingContacts Find(double value)
  {
    const TestVolume volume = MakeVolume(33,
      [value](double x, double, double) { return value + (x < 3 ? 1. : 0.); }); // slope 1 at x = 3
    const Field field(volume.Image, SurfaceOptions(), this->Threads);
    return FindRemainingContacts(this->State, field, this->Threads);
  }
};
}

TEST(ContactCount, CountsFacingVerticesOffIsosurface)
{
  // Maximum distance 1.15 lambda delta = 1.66; minimum value .015, a tenth of the minimum slope.
  for (const double gap : { 1.5, 1.9 })
  {
    for (const double value : { -0.5, -0.01 })
    {
      TwoBalls balls(gap);
      const RemainingContacts found = balls.Find(value);
      const long held = std::count(found.Held.begin(), found.Held.end(), 1);
      EXPECT_EQ(held > 0, gap < 1.6 && value < -0.1) << gap << ' ' << value;
      EXPECT_LT(held, 12);
    }
  }
  // Nested surfaces with outward normals do not face each other.
  IndexedSurface nested = DividedIcosahedron({ 16, 16, 16 }, 6, 1.6);
  AddSurface(nested, DividedIcosahedron({ 16, 16, 16 }, 7.3, 1.6));
  TwoBalls bench(nested);
  const RemainingContacts found = bench.Find(-0.5);
  EXPECT_FALSE(found.Pairs.empty());
  EXPECT_EQ(std::count(found.Held.begin(), found.Held.end(), 1), 0);
}
