// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What judges surfaces of labels, and the shapes that it judges them by.

#include "LabelJudge.h"
#include "SimpleSurfaces.h"
#include "TestPrelude.h"

using namespace volumic::support;

namespace
{

using Vector = std::array<double, 3>;

/** The ring of SimpleSurfaces.h; `slope`: what its function is multiplied with. */
LabelShape Ring(double major, double minor, double slope = 1.0)
{
  LabelShape shape;
  shape.Distance = [=](const Vector& p)
  { return slope * (std::hypot(std::hypot(p[0], p[1]) - major, p[2]) - minor); };
  shape.Volume = 2.0 * 9.869604401089358 * major * minor * minor;
  return shape;
}

void Move(TriangleSurface& surface, const Vector& by)
{
  for (Vector& point : surface.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] += by[a];
    }
  }
}

double VolumeOfLabel(const LabelMap& map, int label)
{
  return static_cast<double>(std::count(map.Values.begin(), map.Values.end(), label)) *
    map.Spacing[0] * map.Spacing[1] * map.Spacing[2];
}

} // namespace

//------------------------------------------------------------------------------
TEST(LabelShapes, HaveTheVolumesOfTheirVoxels)
{
  for (const LabelShapeKind kind : AllLabelShapeKinds())
  {
    for (const double stretch : { 1.0, 3.0 })
    {
      const DigitisedShapes shapes = Digitise(kind, 64, stretch);
      SCOPED_TRACE(shapes.Name);
      EXPECT_EQ(shapes.Map.Size[2], stretch == 1.0 ? 64 : 22);
      for (const LabelShape& shape : shapes.Shapes)
      {
        const double volume = VolumeOfLabel(shapes.Map, shape.Label);
        EXPECT_GT(volume, 1000.0);
        if (shape.Distance)
        {
          EXPECT_NEAR(volume / shape.Volume, 1.0, stretch == 1.0 ? 0.005 : 0.02)
            << "label " << shape.Label;
        }
      }
    }
  }
}

TEST(LabelShapes, StayAwayFromTheBorder)
{
  for (const LabelShapeKind kind : AllLabelShapeKinds())
  {
    const LabelMap map = Digitise(kind, 48).Map;
    for (int i = 0; i < 48 * 48; ++i)
    {
      ASSERT_EQ(map.Values[i], 0);
      ASSERT_EQ(map.Values[map.Values.size() - 1 - i], 0);
    }
  }
}

TEST(LabelShapes, GrowWithTheSizeButForThinWalls)
{
  const auto volume = [](LabelShapeKind kind, int size)
  { return Digitise(kind, size).Shapes.front().Volume; };
  EXPECT_NEAR(volume(LabelShapeKind::Gyroid, 96) / volume(LabelShapeKind::Gyroid, 48), 8.0, 1e-9);
  EXPECT_NEAR(
    volume(LabelShapeKind::ThinShell, 96) / volume(LabelShapeKind::ThinShell, 48), 4.0, 0.2);
}

TEST(LabelShapes, TouchWhereTheyAreSaidToTouch)
{
  const DigitisedShapes balls = Digitise(LabelShapeKind::TouchingBalls, 64);
  ASSERT_EQ(balls.Shapes.size(), 2u);
  double least = 1e30; // of the sum of both distances, over the way from centre to centre
  for (int i = 0; i <= 1000; ++i)
  {
    const double t = -12.0 + 0.025 * i;
    const double length = std::sqrt(0.3 * 0.3 + 0.5 * 0.5 + 0.81 * 0.81);
    const Vector p = { 31.5 + 0.3 / length * t, 31.5 + 0.5 / length * t, 31.5 + 0.81 / length * t };
    least = std::min(least, balls.Shapes[0].Distance(p) + balls.Shapes[1].Distance(p));
  }
  EXPECT_NEAR(least, 0.0, 1e-9);
}

TEST(LabelShapes, RefuseWhatCannotBe)
{
  EXPECT_THROW(Digitise(LabelShapeKind::Sphere, 8), std::invalid_argument);
  EXPECT_THROW(Digitise(LabelShapeKind::Sphere, 64, 0.5), std::invalid_argument);
}

TEST(LabelShapes, FillABodyWithLabels)
{
  const LabelMap map = MakeBodyMap({ 96, 96, 64 }, 20);
  std::map<int, int> counts;
  for (const std::int16_t value : map.Values)
  {
    ++counts[value];
  }
  EXPECT_EQ(counts.size(), 21u);
  EXPECT_GT(counts[0], 96 * 96 * 64 / 2);
}

//------------------------------------------------------------------------------
TEST(JudgeTruth, MeasuresDistanceAndNormals)
{
  // A polygon of n corners in a circle is r (1 - cos(pi / n)) inside it at most.
  const TriangleSurface ring = Torus(120, 60, 10.0, 4.0);
  const TruthVerdict verdict = JudgeTruth(ring, Ring(10.0, 4.0));
  EXPECT_NEAR(verdict.MeanAtVertices, 0.0, 1e-9);
  EXPECT_GT(verdict.MeanAtCentroids, 0.002);
  EXPECT_LT(verdict.MeanAtCentroids, 0.02);
  EXPECT_LT(verdict.MeanAngle, 2.5);
  EXPECT_NEAR(verdict.VolumeError, -0.003, 0.002);

  const TruthVerdict larger = JudgeTruth(ring, Ring(10.0, 3.9));
  EXPECT_NEAR(larger.MeanAtVertices, 0.1, 1e-6);
  EXPECT_NEAR(larger.Largest, 0.1, 1e-3);
  EXPECT_NEAR(larger.VolumeError, 16.0 / (3.9 * 3.9) - 1.0, 0.004);
}

TEST(JudgeTruth, FindsDistancesWhateverTheSlope)
{
  const TriangleSurface ring = Torus(60, 30, 10.0, 4.0);
  EXPECT_NEAR(JudgeTruth(ring, Ring(10.0, 3.7, 5.0)).MeanAtVertices, 0.3, 1e-6);
  LabelShape bent = Ring(10.0, 3.7);
  bent.Distance = [distance = bent.Distance](const Vector& p)
  { return distance(p) * (1.0 + 0.5 * std::sin(p[0])); };
  EXPECT_NEAR(JudgeTruth(ring, bent).MeanAtVertices, 0.3, 0.01);
}

TEST(JudgeTruth, SeesWhereNormalsLook)
{
  const TriangleSurface ring = Reversed(Torus(60, 30, 10.0, 4.0));
  EXPECT_GT(JudgeTruth(ring, Ring(10.0, 4.0)).MeanAngle, 175.0);
}

TEST(JudgeTruth, RefusesAShapeThatIsNotSmooth)
{
  EXPECT_THROW(JudgeTruth(Tetrahedron(), LabelShape()), std::invalid_argument);
}

//------------------------------------------------------------------------------
TEST(JudgeDihedrals, MeasuresAnglesAtEdges)
{
  EXPECT_NEAR(JudgeDihedrals(Sheet(5, 0.0)).Largest, 0.0, 1e-9);
  // Three edges of a cube, three between a side of it and the plane through three corners.
  const DihedralVerdict corner = JudgeDihedrals(Tetrahedron());
  EXPECT_NEAR(corner.Largest, 125.264389682754654, 1e-9);
  EXPECT_NEAR(corner.Quantile95, 125.264389682754654, 1e-9);
  const DihedralVerdict ring = JudgeDihedrals(Torus(60, 36, 10.0, 4.0));
  EXPECT_NEAR(ring.Largest, 10.0, 0.5); // 360 / 36
  EXPECT_LT(ring.Median, ring.Quantile95);
}

//------------------------------------------------------------------------------
TEST(JudgeVoxels, CountsBothSides)
{
  LabelMap map;
  map.Size = { 40, 40, 20 };
  map.Spacing = { 0.8, 0.8, 1.1 };
  map.Origin = { -15.6, -15.41, -10.14 };
  map.Values.resize(40 * 40 * 20);
  const LabelShape ring = Ring(10.0, 4.0);
  std::size_t middle = 0;
  for (int k = 0, v = 0; k < 20; ++k)
  {
    for (int j = 0; j < 40; ++j)
    {
      for (int i = 0; i < 40; ++i, ++v)
      {
        const Vector p = { -15.6 + 0.8 * i, -15.41 + 0.8 * j, -10.14 + 1.1 * k };
        map.Values[v] = ring.Distance(p) < 0.0 ? 7 : 3;
        middle = ring.Distance(p) < -3.0 ? v : middle;
      }
    }
  }
  // Nearer to the ring than any voxel's centre is.
  const TriangleSurface surface = Torus(800, 400, 10.0, 4.0);
  const WrongVoxelVerdict right = JudgeVoxels(surface, map, 7);
  EXPECT_EQ(right.Wrong(), 0u);
  EXPECT_EQ(right.Label, std::count(map.Values.begin(), map.Values.end(), 7));
  map.Values[0] = 7;
  map.Values[1] = 7;
  map.Values[middle] = 3;
  const WrongVoxelVerdict wrong = JudgeVoxels(surface, map, 7);
  EXPECT_EQ(wrong.Outside, 2u);
  EXPECT_EQ(wrong.Inside, 1u);
}

//------------------------------------------------------------------------------
TEST(JudgeOverlap, MeasuresDepth)
{
  const OverlapVerdict inside = JudgeOverlap(Tetrahedron(10.0), Tetrahedron(1.0, { 1, 1, 1 }));
  EXPECT_EQ(inside.VerticesInside, 4u);
  EXPECT_NEAR(inside.MeanDepth, 1.0, 1e-12); // each is 1 from a side of the cube
  EXPECT_NEAR(inside.LargestDepth, 1.0, 1e-12);
  EXPECT_EQ(inside.IntersectingPairs, 0u);
  EXPECT_EQ(JudgeOverlap(Tetrahedron(1.0, { 1, 1, 1 }), Tetrahedron(10.0)).VerticesInside, 4u);
}

TEST(JudgeOverlap, FindsWhatCrosses)
{
  const OverlapVerdict crossing =
    JudgeOverlap(Tetrahedron(10.0), Tetrahedron(1.0, { -0.25, 1.0, 1.0 }));
  EXPECT_EQ(crossing.VerticesInside, 1u);
  EXPECT_NEAR(crossing.MeanDepth, 0.75, 1e-12);
  EXPECT_GT(crossing.IntersectingPairs, 0u);
}

TEST(JudgeOverlap, LeavesNeighboursAlone)
{
  TriangleSurface other = Torus(60, 30, 10.0, 4.0);
  Move(other, { 0.0, 0.0, 8.001 });
  const OverlapVerdict apart = JudgeOverlap(Torus(60, 30, 10.0, 4.0), other);
  EXPECT_EQ(apart.VerticesInside, 0u);
  EXPECT_EQ(apart.IntersectingPairs, 0u);
  Move(other, { 0.0, 0.0, -0.101 });
  EXPECT_GT(JudgeOverlap(Torus(60, 30, 10.0, 4.0), other).IntersectingPairs, 0u);
  EXPECT_EQ(JudgeOverlap(other, TriangleSurface()).VerticesInside, 0u);
}
