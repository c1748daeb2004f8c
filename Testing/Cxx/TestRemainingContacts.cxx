// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Thin walls are reported as remaining contacts and resolved with FinestLevel -1. The counts of the
// filter and of SurfaceJudge must agree.
#include "SupportVtkConversions.h"
#include "SurfaceTestTools.h"

using namespace volumic;
using namespace volumic::support;

namespace
{
/** Return a hollow ball of radius 18, open on one side, with the given wall thickness. */
Scene HollowBall(double wall)
{
  Scene scene = MakeScene(SceneKind::Sphere);
  for (std::size_t voxel = 0; voxel < scene.Values.size(); ++voxel)
  {
    const double x = voxel % 64 - 31.5;
    const double y = voxel / 64 % 64 - 31.5;
    const double z = voxel / 64 / 64 - 31.5;
    const double radius = std::sqrt(x * x + y * y + z * z);
    const double height = 0.301 * x + 0.501 * y + 0.8116 * z;
    const double beside =
      height > 0 ? std::sqrt(std::max(0., radius * radius - height * height)) : radius;
    const double distance = std::max({ radius - 18, 18 - wall - radius, 6 - beside });
    scene.Values[voxel] = static_cast<float>(50. * std::erfc(2. * distance));
  }
  scene.IsoValue = 50;
  return scene;
}

class RemainingContacts : public ::testing::Test
{
protected:
  void Run(double wall)
  {
    this->Content = HollowBall(wall);
    this->Filter->SetInputData(ToImage(this->Content));
    this->Filter->SetIsoValue(this->Content.IsoValue);
    this->Filter->SetCoarsestLevel(0);
    this->Filter->Update();
  }

  void ExpectCountsOfTheJudge(vtkPolyData* surface)
  {
    const LengthVerdict verdict =
      JudgeLengths(ToTriangleSurface(surface), FieldOf(surface, "Delta"));
    EXPECT_EQ(FieldOf(surface, "RemainingContacts"), verdict.NearPairs);
    vtkDataArray* contact = surface->GetPointData()->GetArray("Contact");
    int vertices = 0;
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      vertices += contact->GetComponent(i, 0) == 1;
    }
    EXPECT_EQ(FieldOf(surface, "ContactVertices"), vertices);
  }

  Scene Content;
  vtkNew<vtkDeformableSurface> Filter;
};
}

TEST_F(RemainingContacts, NoneForThickWall)
{
  this->Run(3);
  EXPECT_EQ(FieldOf(this->Filter->GetOutput(), "RemainingContacts"), 0);
  EXPECT_EQ(FieldOf(this->Filter->GetOutput(), "ContactVertices"), 0);
  this->ExpectCountsOfTheJudge(this->Filter->GetOutput());
}

TEST_F(RemainingContacts, ReportThinWallUntilResolvedByFinerLevel)
{
  this->Run(1); // Less than 2.5/sqrt(3) delta = 1.23.
  vtkPolyData* surface = this->Filter->GetOutput();
  this->ExpectCountsOfTheJudge(surface);
  const double fraction =
    FieldOf(surface, "ContactVertices") / static_cast<double>(surface->GetNumberOfPoints());
  EXPECT_GT(fraction, 0.2);
  this->Filter->SetFinestLevel(-1);
  this->Filter->Update();
  surface = this->Filter->GetOutput();
  this->ExpectCountsOfTheJudge(surface);
  EXPECT_LT(FieldOf(surface, "ContactVertices") / surface->GetNumberOfPoints(), 0.2 * fraction);
}

TEST(FinerThanImage, DividesOnceMoreAndKeepsTheConstraints)
{
  const Scene scene = MakeScene(SceneKind::Torus);
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(ToImage(scene));
  filter->SetIsoValue(scene.IsoValue);
  filter->SetCoarsestLevel(scene.CoarsestFaithfulLevel);
  filter->SetFinestLevel(-1);
  filter->Update();
  vtkPolyData* surface = filter->GetOutput();
  auto* level0 = vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(0));
  EXPECT_EQ(FieldOf(surface, "Level"), -1);
  EXPECT_NEAR(FieldOf(surface, "Delta") / FieldOf(level0, "Delta"), 1 / std::sqrt(3.), 1e-6);
  EXPECT_NEAR(
    static_cast<double>(surface->GetNumberOfPoints()) / level0->GetNumberOfPoints(), 3.0, 0.3);
  const SurfaceVerdict verdict =
    JudgeSurface(ToTriangleSurface(surface), FieldOf(surface, "Delta"));
  EXPECT_TRUE(verdict.IsSound()) << Describe(verdict);
  EXPECT_EQ(verdict.Topology.Components.size(), 1u);
  EXPECT_EQ(verdict.Topology.Genus, 1);
  EXPECT_EQ(verdict.Lengths.EdgesTooShort + verdict.Lengths.EdgesTooLong, 0u);
  EXPECT_EQ(verdict.Lengths.NearPairs, 0u);
  const auto distanceOf = [&](vtkPolyData* judged)
  { return JudgeIsoDistance(ToTriangleSurface(judged), ToJudgedVolume(scene)).MeanAtCentroids; };
  EXPECT_LT(distanceOf(surface), 0.6 * distanceOf(level0));
}

TEST_F(RemainingContacts, AreCountedInSnapshots)
{
  // Snapshots contain the surface before its contacts are resolved.
  this->Filter->SetSnapshotInterval(5);
  this->Run(1);
  vtkMultiBlockDataSet* snapshots = this->Filter->GetSnapshots();
  double largest = 0;
  for (unsigned int b = 1; b < snapshots->GetNumberOfBlocks(); ++b)
  {
    auto* surface = vtkPolyData::SafeDownCast(snapshots->GetBlock(b));
    if (b % 8 == 0)
    {
      this->ExpectCountsOfTheJudge(surface);
    }
    largest = std::max(largest, FieldOf(surface, "RemainingContacts"));
  }
  EXPECT_GT(largest, 20);
}
