// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/Field.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "CoreTestTools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace volumic;

namespace
{
SequentialExecutor Threads;

/** Object for x < 10. */
TestVolume Half()
{
  return MakeVolume(20, [](double x, double, double) { return 10 - x; });
}
}

TEST(InitialSurface, DividedIcosahedraLieOnTheirSphere)
{
  for (const double edge : { 3., 1., 0.4 })
  {
    const IndexedSurface sphere = DividedIcosahedron({ 1, 2, 3 }, 2.5, edge);
    for (const Point& p : sphere.Points)
    {
      EXPECT_NEAR(Distance(p[0], p[1], p[2], 1, 2, 3), 2.5, 1e-5);
    }
    EXPECT_NO_THROW(CheckInitialSurface(sphere));
    const double perVertex =
      ComputeFeatures(sphere).Area / static_cast<double>(sphere.Points.size());
    EXPECT_LT(perVertex, std::sqrt(0.75) * edge * edge * 1.1) << "edges of " << edge;
  }
}

TEST(InitialSurface, EnclosingSurfaceIsARoundedBoxThroughTheCornersOfTheImage)
{
  LevelImage image;
  image.Size = { 30, 20, 10 };
  image.Step = { 1, 1, 2 };
  const IndexedSurface box = EnclosingSurface(image, 2.);
  EXPECT_NO_THROW(CheckInitialSurface(box));
  const double half[3] = { 14.5 + 1, 9.5 + 1, 9 + 2 }; // A voxel beyond the outermost ones.
  for (const Point& p : box.Points)
  {
    double sum = 0;
    const double centre[3] = { 14.5, 9.5, 9 };
    for (int k = 0; k < 3; ++k)
    {
      sum += std::pow((p[k] - centre[k]) / half[k], 4);
    }
    EXPECT_NEAR(sum, 3, 1e-3) << "3 at the corners of that box, and on all of the surface";
  }
}

TEST(InitialSurface, SeedsLieInTheObjectAndApart)
{
  const TestVolume volume = Half();
  const Field field(volume.Image, SurfaceOptions(), Threads);
  const std::vector<Point> chosen = ChooseSeeds(
    field, { { 5, 5, 5 }, { 5, 5, 7.9 }, { 5, 5, 8.1 }, { 15, 5, 5 }, { 9, 12, 5 } }, 3);
  const std::vector<Point> expected = { { 5, 5, 5 }, { 5, 5, 8.1 }, { 9, 12, 5 } };
  EXPECT_EQ(chosen, expected);
  EXPECT_THROW(ChooseSeeds(field, { { 5, 5, 25 } }, 3), std::invalid_argument);
  EXPECT_THROW(ChooseSeeds(field, { { -1, 5, 5 } }, 3), std::invalid_argument);
  EXPECT_THROW(ChooseSeeds(field, { { 15, 5, 5 } }, 3), std::invalid_argument);
}

TEST(InitialSurface, WithoutPlacesSeedsAreAGridInTheObject)
{
  const TestVolume volume = Half();
  const Field field(volume.Image, SurfaceOptions(), Threads);
  const std::vector<Point> chosen = ChooseSeeds(field, {}, 4);
  EXPECT_EQ(chosen.size(), 3u * 5 * 5) << "at x = 1.5, 5.5 and 9.5";
  for (const Point& p : chosen)
  {
    EXPECT_LT(p[0], 10);
  }
}
