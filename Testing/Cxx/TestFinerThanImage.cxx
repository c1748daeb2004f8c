// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// FinestLevel -1: a last division on the field of level 0, for walls thinner than its triangles.
#include "SupportVtkConversions.h"
#include "TestPrelude.h"
#include "vtkDeformableSurface.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkTable.h>

using namespace volumic::support;

namespace
{
double FieldOf(vtkPolyData* surface, const char* name)
{
  return surface->GetFieldData()->GetArray(name)->GetComponent(0, 0);
}

SurfaceVerdict Judge(vtkPolyData* surface, const JudgedVolume& volume)
{
  return JudgeSurface(ToTriangleSurface(surface), FieldOf(surface, "Delta"), &volume);
}

class FinerThanImage : public ::testing::Test
{
protected:
  void Run(SceneKind kind)
  {
    this->Content = MakeScene(kind);
    this->Evolve();
  }

  void Evolve()
  {
    this->Filter->SetInputData(ToImage(this->Content));
    this->Filter->SetIsoValue(this->Content.IsoValue);
    this->Filter->SetCoarsestLevel(this->Content.CoarsestFaithfulLevel);
    this->Filter->SetFinestLevel(-1);
    this->Filter->Update();
  }

  vtkPolyData* Block(unsigned int index)
  {
    return vtkPolyData::SafeDownCast(this->Filter->GetLevels()->GetBlock(index));
  }

  Scene Content;
  vtkNew<vtkDeformableSurface> Filter;
};
}

TEST_F(FinerThanImage, DividesOnceMoreAndKeepsTheConstraints)
{
  this->Run(SceneKind::Torus);
  vtkPolyData* surface = this->Filter->GetOutput();
  vtkPolyData* level0 = this->Block(0);
  EXPECT_EQ(FieldOf(surface, "Level"), -1);
  EXPECT_NEAR(FieldOf(surface, "Unit") / FieldOf(level0, "Unit"), 1 / std::sqrt(3.), 1e-6);
  EXPECT_NEAR(FieldOf(surface, "Delta") / FieldOf(level0, "Delta"), 1 / std::sqrt(3.), 1e-6);
  EXPECT_NEAR(
    static_cast<double>(surface->GetNumberOfPoints()) / level0->GetNumberOfPoints(), 3.0, 0.3);
  const SurfaceVerdict verdict = Judge(surface, ToJudgedVolume(this->Content));
  EXPECT_TRUE(verdict.Topology.Outward);
  EXPECT_EQ(verdict.Topology.Components.size(), 1u);
  EXPECT_EQ(verdict.Topology.Genus, 1);
  EXPECT_EQ(verdict.Intersections.Pairs, 0u);
  EXPECT_EQ(verdict.Lengths.EdgesTooShort + verdict.Lengths.EdgesTooLong, 0u);
  EXPECT_EQ(verdict.Lengths.NearPairs, 0u);
  EXPECT_GT(verdict.Shapes.Mean, 0.95);
  const SurfaceVerdict before = Judge(level0, ToJudgedVolume(this->Content));
  EXPECT_LT(verdict.IsoDistance.MeanAtCentroids, 0.6 * before.IsoDistance.MeanAtCentroids);
}

TEST_F(FinerThanImage, HoldsAWallThatIsTooThinForLevel0)
{
  // A hollow ball of radius 18 with a wall of two voxels and sharp edges, open on one side.
  this->Content = MakeScene(SceneKind::Sphere);
  for (std::size_t voxel = 0; voxel < this->Content.Values.size(); ++voxel)
  {
    const double x = voxel % 64 - 31.5;
    const double y = voxel / 64 % 64 - 31.5;
    const double z = voxel / 64 / 64 - 31.5;
    const double radius = std::sqrt(x * x + y * y + z * z);
    const double height = 0.301 * x + 0.501 * y + 0.8116 * z; // along the axis of the opening
    const double beside =
      height > 0 ? std::sqrt(std::max(0., radius * radius - height * height)) : radius;
    const double distance = std::max({ radius - 18, 16 - radius, 6 - beside });
    this->Content.Values[voxel] = static_cast<float>(50. * std::erfc(2. * distance));
  }
  this->Content.IsoValue = 50;
  this->Content.CoarsestFaithfulLevel = 1;
  this->Evolve();
  const JudgedVolume volume = ToJudgedVolume(this->Content);
  const SurfaceVerdict coarse = Judge(this->Block(0), volume);
  const SurfaceVerdict fine = Judge(this->Filter->GetOutput(), volume);
  EXPECT_EQ(fine.Topology.Components.size(), 1u);
  EXPECT_EQ(fine.Topology.Genus, 0);
  EXPECT_EQ(fine.Intersections.Pairs, 0u);
  EXPECT_EQ(fine.Lengths.NearPairs, 0u);
  EXPECT_LT(fine.IsoDistance.MeanAtVertices, 0.02);
  EXPECT_GT(coarse.IsoDistance.MeanAtVertices, 2 * fine.IsoDistance.MeanAtVertices)
    << "the wall must be one that needs it";
}
