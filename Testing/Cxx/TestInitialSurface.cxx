// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LatticeSurface.h"
#include "Core/Mesh/ObliqueRotation.h"
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

/** Triangulated cylinder as of vtkCylinderSource: caps are fans, sides are slivers. */
IndexedSurface Cylinder(double radius, double height, int sides)
{
  IndexedSurface surface;
  for (double z : { 19.5 - 0.5 * height, 19.5 + 0.5 * height })
  {
    for (int i = 0; i < sides; ++i)
    {
      const double a = 2 * 3.14159265358979 * i / sides;
      surface.Points.push_back({ 19.5 + radius * std::cos(a), 19.5 + radius * std::sin(a), z });
    }
  }
  for (int i = 0; i < sides; ++i)
  {
    const int next = (i + 1) % sides;
    surface.Triangles.push_back({ i, next, sides + next });
    surface.Triangles.push_back({ sides + next, sides + i, i });
  }
  for (int i = 1; i + 1 < sides; ++i)
  {
    surface.Triangles.push_back({ 0, i + 1, i });
    surface.Triangles.push_back({ sides, sides + i, sides + i + 1 });
  }
  return surface;
}

std::string ErrorMessageOf(const IndexedSurface& surface)
{
  const TestVolume volume = BallVolume(40, 12);
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  return volumic::ErrorMessageOf([&] { evolution.StartSurface(volume.Image, 0, surface); });
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

TEST(InitialSurfaceCheck, PreservesComponentsCavitiesAndTunnels)
{
  const TestVolume volume = BallVolume(40, 12);
  IndexedSurface given = MakeTorus({ 12, 12, 8 }, 7, 3, 9, 6);
  AddSurface(given, Cuboid({ 20, 20, 16 }, { 38, 38, 36 }));
  AddSurface(given, InsideOut(Cuboid({ 24, 24, 20 }, { 34, 34, 32 })));
  AddSurface(given, DividedIcosahedron({ 8, 30, 30 }, 5, 0.1));
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  evolution.StartSurface(volume.Image, 0, given);
  const SurfaceResult start = evolution.Result();
  ExpectValidMesh(start);
  ExpectEdgesWithin(start, 0.999 * start.Delta, 2.501 * start.Delta);
  const SurfaceFeatures features = ComputeFeatures(start);
  EXPECT_EQ(features.Components.size(), 4u);
  EXPECT_EQ(features.Genus, 1);
  EXPECT_NEAR(features.Volume / ComputeFeatures(given).Volume, 1., 0.03);
}

TEST(InitialSurfaceCheck, PreservesValidMesh)
{
  const TestVolume volume = BallVolume(40, 12);
  TestEvolution first(IsoHalf(), Threads, Silent);
  first.RunEnclosing(volume.Image, 0);
  const SurfaceResult converged = first.Result();
  TestEvolution second(IsoHalf(), Threads, Silent);
  IndexedSurface withMore = converged;
  withMore.Points.insert(withMore.Points.begin(), { 1, 2, 3 }); // unused point
  for (Triangle& t : withMore.Triangles)
  {
    t = { t[0] + 1, t[1] + 1, t[2] + 1 };
  }
  second.StartSurface(volume.Image, 0, withMore);
  const SurfaceResult again = second.Result();
  ASSERT_EQ(again.Points.size(), converged.Points.size());
  EXPECT_NEAR(ComputeFeatures(again).Volume, ComputeFeatures(converged).Volume, 1e-6);
}

TEST(InputSurfaceInvalid, RejectsWrongUnitsAndTooSmallSurfaces)
{
  const std::string large = ErrorMessageOf(Cylinder(13000, 25500, 12));
  EXPECT_TRUE(Has(large, "too large for the image"));
  EXPECT_TRUE(Has(large, "26000"));
  EXPECT_TRUE(Has(large, "the image 40"));
  EXPECT_TRUE(Has(large, "unit"));
  EXPECT_EQ(ErrorMessageOf(Cylinder(35, 70, 12)), "") << "larger than the image";
  const std::string thin = ErrorMessageOf(Cuboid({ 10, 10, 19.5 }, { 30, 30, 19.7 }));
  EXPECT_TRUE(Has(thin, "too thin for this level"));
  EXPECT_TRUE(Has(thin, "finer level"));
  EXPECT_EQ(ErrorMessageOf(Cuboid({ 10, 10, 19.5 }, { 30, 30, 20.9 })), "");
  const std::string small = ErrorMessageOf(DividedIcosahedron({ 19.5, 19.5, 19.5 }, 1.0, 0.2));
  EXPECT_TRUE(Has(small, "too small for this level"));
  EXPECT_EQ(ErrorMessageOf(DividedIcosahedron({ 19.5, 19.5, 19.5 }, 3., 0.2)), "");
}

TEST(InputSurfaceInvalid, RejectsMisorientedComponents)
{
  const IndexedSurface box = Cuboid({ 5, 5, 5 }, { 35, 35, 35 });
  const IndexedSurface inner = Cuboid({ 12, 12, 12 }, { 28, 28, 28 });
  IndexedSurface twice = box;
  AddSurface(twice, inner);
  EXPECT_TRUE(Has(ErrorMessageOf(twice), "1 of its 2 components have the wrong orientation"));
  IndexedSurface beside = Cuboid({ 5, 5, 5 }, { 20, 35, 35 });
  AddSurface(beside, InsideOut(Cuboid({ 25, 5, 5 }, { 35, 35, 35 })));
  EXPECT_TRUE(Has(ErrorMessageOf(beside), "have the wrong orientation"));
  IndexedSurface hollow = box;
  AddSurface(hollow, InsideOut(inner));
  AddSurface(hollow, Cuboid({ 16, 16, 16 }, { 24, 24, 24 }));
  EXPECT_EQ(ErrorMessageOf(hollow), "") << "a component in a cavity";
}

TEST(LatticeSurface, IsValidForAnyLattice)
{
  const IndexedSurface given = Cylinder(9, 14, 50);
  const SurfaceFeatures requested = ComputeFeatures(given);
  for (double pitch : { 0.8, 1.3, 4. })
  {
    for (int attempt = 0; attempt < ObliqueRotation::Count; ++attempt)
    {
      const IndexedSurface mesh =
        RemeshOnLattice(given, pitch, attempt, Threads, [](double) { return true; });
      ExpectValidMesh(mesh);
      const SurfaceFeatures features = ComputeFeatures(mesh);
      EXPECT_EQ(features.EulerCharacteristic, 2);
      EXPECT_NEAR(features.Volume / requested.Volume, 1., 0.02 * pitch * pitch);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_NEAR(
          features.Components[0].Centroid[k], requested.Components[0].Centroid[k], 0.1 * pitch)
          << "rotated back";
      }
      ExpectEdgesWithin(mesh, 0.1 * pitch, 2. * pitch);
    }
  }
}
