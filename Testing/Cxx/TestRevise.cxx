// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
const Point Middle = { 16., 16., 16. };

/** Positive inside a ball about the middle, as the field of a label is: about the distance. */
TestVolume DistanceToBall(double radius)
{
  return MakeVolume(32, [radius](double x, double y, double z)
    { return std::clamp(radius - Distance(x, y, z, 16., 16., 16.), -4., 4.); });
}

/** Raises what is near a place beside the ball, so that the boundary goes out there. */
void MakeBump(TestVolume& volume)
{
  for (std::size_t v = 0; v < volume.Values.size(); ++v)
  {
    const double off = Distance(static_cast<double>(v % 32), static_cast<double>(v / 32 % 32),
      static_cast<double>(v / 1024), 16., 16., 25.);
    volume.Values[v] += static_cast<float>(0.6 * std::exp(-0.5 * off * off / 2.));
  }
}

double RadiusOf(const Point& p)
{
  return Distance(p[0], p[1], p[2], Middle[0], Middle[1], Middle[2]);
}

class Revise : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Evolution.StartIsoSurface(
      this->Volume.Image, 0, DividedIcosahedron(Middle, 9.2, 1.2));
    this->Evolution.Run();
    this->Before = this->Evolution.Result();
  }

  TestVolume Volume = DistanceToBall(9.2);
  TestEvolution Evolution{ SurfaceOptions(), Threads, Silent };
  SurfaceResult Before;
};
}

TEST_F(Revise, TheSurfaceGoesWhereTheFieldHasChangedAndStaysElsewhere)
{
  MakeBump(this->Volume);
  volumic::Revise(*this->Evolution.Now);
  const SurfaceResult after = this->Evolution.Result();
  const std::set<Point> before(this->Before.Points.begin(), this->Before.Points.end());
  double most = 0.;
  double offAtBump = 0.;
  int moved = 0;
  for (std::size_t i = 0; i < after.Points.size(); ++i)
  {
    const Point& p = after.Points[i];
    most = std::max(most, RadiusOf(p));
    moved += before.count(p) == 0;
    if (p[2] > 24.)
    {
      offAtBump = std::max(offAtBump, static_cast<double>(std::abs(after.Residual[i])));
    }
    ASSERT_TRUE(p[2] > 16. || before.count(p) == 1) << "the other side stays";
  }
  EXPECT_GT(most, 9.5);
  EXPECT_LT(offAtBump, 0.05) << "on the isopotential as it is now";
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, static_cast<int>(after.Points.size()) / 4);
  EXPECT_EQ(CountSelfIntersections(after, 1), 0);
  EXPECT_EQ(ComputeFeatures(after).EulerCharacteristic, 2);
  for (const double length : EdgeLengths(after))
  {
    ASSERT_GE(length, 0.999 * after.Delta);
    ASSERT_LE(length, 1.001 * SizingField::LongestEdgeInDelta * after.Delta);
  }
}

TEST_F(Revise, NothingMovesWhereNothingHasChanged)
{
  volumic::Revise(*this->Evolution.Now);
  EXPECT_EQ(this->Evolution.Result().Points, this->Before.Points);
  EXPECT_EQ(this->Evolution.Result().Triangles, this->Before.Triangles);
}

TEST(StartIsoSurface, IsTheStartFromAGivenSurfaceWithoutItsTests)
{
  const TestVolume volume = DistanceToBall(9.2);
  const IndexedSurface sphere = DividedIcosahedron(Middle, 9.2, 1.2);
  TestEvolution tested(SurfaceOptions(), Threads, Silent);
  tested.StartSurface(volume.Image, 0, sphere);
  TestEvolution known(SurfaceOptions(), Threads, Silent);
  known.StartIsoSurface(volume.Image, 0, sphere);
  EXPECT_EQ(known.Result().Points, tested.Result().Points);
  EXPECT_EQ(known.Result().Triangles, tested.Result().Triangles);
  EXPECT_THROW(known.StartIsoSurface(volume.Image, 0, IndexedSurface()), std::invalid_argument);
}

TEST(StartIsoSurface, WithEdgesThatAreTooLongKeepsItsPoints)
{
  // As where voxels are long: a lattice in its place would have other points, and costs more.
  const TestVolume volume = DistanceToBall(9.2);
  const IndexedSurface coarse = DividedIcosahedron(Middle, 9.2, 5.);
  TestEvolution evolution(SurfaceOptions(), Threads, Silent);
  evolution.StartIsoSurface(volume.Image, 0, coarse);
  const SurfaceResult start = evolution.Result();
  EXPECT_GT(start.Points.size(), 2 * coarse.Points.size());
  for (const Point& p : coarse.Points)
  {
    const bool isThere = std::any_of(start.Points.begin(), start.Points.end(), [&p](const Point& q)
      { return Distance(p[0], p[1], p[2], q[0], q[1], q[2]) < 1e-4; });
    EXPECT_TRUE(isThere) << p[0] << ' ' << p[1] << ' ' << p[2];
  }
}
