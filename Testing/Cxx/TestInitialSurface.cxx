// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Image/Field.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
/** Object for x < 10. */
TestVolume Half()
{
  return MakeVolume(20, [](double x, double, double) { return 10 - x; });
}

LevelImage ImageOf(const std::array<int, 3>& size, const Point& step)
{
  LevelImage image;
  image.Size = size;
  image.Step = step;
  return image;
}

VectorD CornerOf(const IndexedSurface& surface, int i)
{
  const Point& p = surface.Points[i];
  return VectorD(p[0], p[1], p[2]);
}
}

TEST(InitialSurface, EnclosingSurfaceHasLegalEdgesWhateverTheBox)
{
  // Voxels of 1 : 20, sheets, rods, a single cell: a sphere mapped to these had edges of .1 delta.
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
      const std::vector<double> lengths = EdgeLengths(box);
      EXPECT_GE(*std::min_element(lengths.begin(), lengths.end()), 1.1 * delta);
      EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), 2. * delta);
      SurfaceMesh mesh;
      mesh.Append(box);
      for (const Ring& ring : mesh.Rings)
      {
        EXPECT_GE(ring.Count, 4) << "else an edit would have to remove it";
        EXPECT_LE(ring.Count, 8);
      }
    }
  }
}

TEST(InitialSurface, RefusesToEncloseVoxelsOfAnyLength)
{
  EXPECT_NO_THROW(EnclosingSurface(ImageOf({ 20, 20, 20 }, { 1, 1, 1000 }), 1.));
  for (const double step : { 1e6, 1e20, 1e300 })
  {
    EXPECT_TRUE(Has(RefusalOf([&] { EnclosingSurface(ImageOf({ 20, 20, 20 }, { 1, 1, step }), 1.); }),
      "times as long as wide. Check the Spacing"));
  }
}

TEST(InitialSurface, RefusesAnAreaOfTooManyVertices)
{
  const LevelImage image = ImageOf({ 20, 20, 20 }, { 1, 1, 1e6 });
  EXPECT_NO_THROW(CheckNumberOfVertices(1e7, image, 1.));
  EXPECT_THROW(CheckNumberOfVertices(1e8, image, 1.), std::invalid_argument);
}

TEST(InitialSurface, EnclosingSurfaceIsJustOutsideTheImage)
{
  const double delta = 0.85;
  const LevelImage image = ImageOf({ 30, 20, 10 }, { 1, 1, 2 });
  const IndexedSurface box = EnclosingSurface(image, delta);
  // A voxel beyond the outermost ones lie the corners of a box that has to be inside.
  const double low[3] = { -1., -1., -2. };
  const double high[3] = { 30., 20., 20. };
  for (const Triangle& t : box.Triangles)
  {
    const VectorD a = CornerOf(box, t[0]);
    const VectorD normal = Cross(CornerOf(box, t[1]) - a, CornerOf(box, t[2]) - a);
    for (int corner = 0; corner < 8; ++corner)
    {
      const VectorD p(corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
        corner & 4 ? high[2] : low[2]);
      EXPECT_LE(Dot(normal, p - a), 1e-9) << "corner " << corner << " is beyond a face";
    }
  }
  for (const Point& p : box.Points)
  {
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_GT(p[k], low[k] - 2. * delta);
      EXPECT_LT(p[k], high[k] + 2. * delta);
    }
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
