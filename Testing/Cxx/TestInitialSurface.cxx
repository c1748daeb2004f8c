// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
LevelImage ImageOf(const std::array<int, 3>& size, const Point& step)
{
  LevelImage image;
  image.Size = size;
  image.Step = step;
  return image;
}
}

TEST(InitialSurface, EnclosingSurfaceHasValidEdgesForAnyBox)
{
  // Anisotropic voxels, sheets, rods, a single cell.
  for (const LevelImage& image : { ImageOf({ 30, 20, 10 }, { 1, 1, 2 }),
         ImageOf({ 33, 52, 59 }, { 1, 1.02, 7.55 }), ImageOf({ 4, 4, 90 }, { 1, 1, 20 }),
         ImageOf({ 90, 60, 3 }, { 1, 1, 1 }), ImageOf({ 2, 2, 2 }, { 1, 1, 1 }) })
  {
    for (const double delta : { 0.7, 0.85, 3., 20. })
    {
      const IndexedSurface box = EnclosingSurface(image, delta);
      EXPECT_NO_THROW(CheckInitialSurface(box));
      EXPECT_EQ(CountSelfIntersections(box), 0);
      EXPECT_GT(ComputeFeatures(box).Volume, 0.) << "outward oriented";
      ExpectEdgesWithin(box, 1.1 * delta, 2. * delta);
      const SurfaceMesh mesh = MeshOf(box);
      for (const Ring& ring : mesh.Rings)
      {
        EXPECT_GE(ring.Count, 4);
        EXPECT_LE(ring.Count, 8);
      }
    }
  }
}

TEST(InitialSurface, RejectsExtremeSpacingAndTooManyVertices)
{
  EXPECT_NO_THROW(EnclosingSurface(ImageOf({ 20, 20, 20 }, { 1, 1, 1000 }), 1.));
  for (const double step : { 1e6, 1e20, 1e300 })
  {
    const LevelImage image = ImageOf({ 20, 20, 20 }, { 1, 1, step });
    EXPECT_TRUE(Has(ErrorMessageOf([&] { EnclosingSurface(image, 1.); }),
      "times as long as wide. Check the Spacing"));
  }
  const LevelImage image = ImageOf({ 20, 20, 20 }, { 1, 1, 1e6 });
  EXPECT_NO_THROW(CheckNumberOfVertices(1e7, image, 1.));
  EXPECT_THROW(CheckNumberOfVertices(1e8, image, 1.), std::invalid_argument);
}

TEST(InitialSurface, SeedsAreInObjectAndApart)
{
  const TestVolume volume = MakeVolume(20, [](double x, double, double) { return 10 - x; });
  const Field field(volume.Image, SurfaceOptions(), Threads);
  const std::vector<Point> chosen = ChooseSeeds(
    field, { { 5, 5, 5 }, { 5, 5, 7.9 }, { 5, 5, 8.1 }, { 15, 5, 5 }, { 9, 12, 5 } }, 3);
  const std::vector<Point> expected = { { 5, 5, 5 }, { 5, 5, 8.1 }, { 9, 12, 5 } };
  EXPECT_EQ(chosen, expected);
  EXPECT_THROW(ChooseSeeds(field, { { 5, 5, 25 } }, 3), std::invalid_argument);
  EXPECT_THROW(ChooseSeeds(field, { { -1, 5, 5 } }, 3), std::invalid_argument);
  EXPECT_THROW(ChooseSeeds(field, { { 15, 5, 5 } }, 3), std::invalid_argument);
  // Default seeds form a grid in the object.
  const std::vector<Point> grid = ChooseSeeds(field, {}, 4);
  EXPECT_EQ(grid.size(), 3u * 5 * 5) << "at x = 1.5, 5.5 and 9.5";
  for (const Point& p : grid)
  {
    EXPECT_LT(p[0], 10);
  }
}

TEST(InitialSurface, IsosurfaceHasSmallestParts)
{
  const TestVolume volume = MakeVolume(32,
    [](double x, double y, double z)
    {
      const bool isAlone = x == 3. && y == 4. && z == 5.;
      return isAlone ? 1. : std::clamp(6. - Distance(x, y, z, 16., 16., 16.), -1., 1.);
    });
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  evolution.StartIsoSurface(volume.Image, 0);
  EXPECT_EQ(evolution.Current->Components.NumberOfComponents(), 2);
  const TestVolume nothing = MakeVolume(16, [](double, double, double) { return -1.; });
  EXPECT_THROW(evolution.StartIsoSurface(nothing.Image, 0), std::invalid_argument);
}
