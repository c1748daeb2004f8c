// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkTable.h>

using namespace volumic;

TEST(DeformableSurface, IsInWorldCoordinates)
{
  const auto image = BallImage(40, 36, 40, 0.3);
  image->SetExtent(5, 44, -9, 26, 100, 139);
  image->SetOrigin(-300, 50, 1000);
  image->SetSpacing(0.5, 0.5, 0.5);
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  const double direction[9] = { c, -s, 0, s, c, 0, 0, 0, 1 };
  image->SetDirectionMatrix(direction);
  const auto filter = SurfaceOf(image);
  const double index[3] = { 5 + 19.5, -9 + 17.5, 100 + 19.5 };
  double centre[3];
  image->TransformContinuousIndexToPhysicalPoint(index, centre);
  ExpectSphere(filter->GetOutput(), centre, 0.3 * 36 * 0.5, 0.1);
  EXPECT_NEAR(FieldOf(filter->GetOutput(), "Unit"), 0.5, 1e-12);
}

TEST(DeformableSurface, IsBitIdenticalForAnyNumberOfThreadsAndRuns)
{
  const auto image = BallImage(48, 48, 48);
  const auto one = SurfaceOf(image, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(1); });
  for (const int threads : { 1, 2, 3 })
  {
    const auto other =
      SurfaceOf(image, [&](vtkDeformableSurface* f) { f->SetNumberOfThreads(threads); });
    ASSERT_GT(other->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(AreSameSurfaces(other->GetOutput(), one->GetOutput())) << threads << " threads";
  }
}

TEST(DeformableSurfaceOutputs, HasTheDocumentedArrays)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  vtkPolyData* surface = filter->GetOutput();
  ExpectSphere(surface, BallCentre, BallRadius, 0.2);
  EXPECT_EQ(StopReason(surface), "converged");
  vtkPointData* points = surface->GetPointData();
  ASSERT_TRUE(points->GetNormals());
  EXPECT_STREQ(points->GetNormals()->GetName(), "Normals");
  EXPECT_EQ(points->GetNormals()->GetDataType(), VTK_FLOAT);
  ASSERT_TRUE(points->GetArray("Residual"));
  double range[2];
  points->GetArray("Residual")->GetRange(range);
  EXPECT_LT(std::max(-range[0], range[1]), 5.0) << "vertices lie on the isopotential";
  // The quantile is neither too large nor too small.
  const double quantile = FieldOf(surface, "ResidualQuantile");
  int within = 0;
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p)
  {
    within += std::abs(points->GetArray("Residual")->GetComponent(p, 0)) <= quantile ? 1 : 0;
  }
  EXPECT_NEAR(within / static_cast<double>(surface->GetNumberOfPoints()), 0.98, 0.005);
  EXPECT_GT(quantile, 0.0);
  ASSERT_TRUE(points->GetArray("Motionless"));
  EXPECT_EQ(points->GetArray("Motionless")->GetDataType(), VTK_UNSIGNED_CHAR);
  ASSERT_TRUE(surface->GetCellData()->GetArray("Component"));
  EXPECT_EQ(surface->GetCellData()->GetArray("Component")->GetDataType(), VTK_INT);
  EXPECT_EQ(surface->GetCellData()->GetArray("Component")->GetNumberOfTuples(),
    surface->GetNumberOfCells());
  for (const auto& [name, value] : std::map<std::string, double>{ { "Level", 0 }, { "Genus", 0 },
         { "NumberOfComponents", 1 }, { "EulerCharacteristic", 2 }, { "MissingBoundary", 0 },
         { "MissingParts", 0 }, { "Unit", 1 }, { "ComponentGenus", 0 }, { "ComponentOwner", 0 } })
  {
    EXPECT_NEAR(FieldOf(surface, name.c_str()), value, 1e-12) << name;
  }
  for (const char* name :
    { "Area", "Iterations", "ComponentArea", "ComponentVolume", "ComponentCentroid" })
  {
    EXPECT_GT(FieldOf(surface, name), 0.0) << name;
  }
  EXPECT_TRUE(surface->GetFieldData()->GetArray("ComponentInertia"));
  EXPECT_NEAR(FieldOf(surface, "Delta"), filter->GetSamplingRatio(), 1e-6);
  EXPECT_NEAR(FieldOf(surface, "Volume"), EnclosedVolume(surface), 1e-6 * EnclosedVolume(surface));
}

TEST(DeformableSurfaceOutputs, KeepsTheSurfaceOfEveryLevel)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  vtkMultiBlockDataSet* levels = filter->GetLevels();
  ASSERT_EQ(levels->GetNumberOfBlocks(), 3u);
  for (int h = 0; h < 3; ++h)
  {
    EXPECT_STREQ(levels->GetMetaData(h)->Get(vtkCompositeDataSet::NAME()),
      ("Level " + std::to_string(h)).c_str());
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(h));
    ASSERT_TRUE(surface);
    EXPECT_EQ(FieldOf(surface, "Level"), h);
    EXPECT_NEAR(FieldOf(surface, "Unit"), std::pow(3.0, h / 2.0), 1e-9);
    ASSERT_GT(surface->GetNumberOfPoints(), 0);
  }
  EXPECT_GT(levels->GetBlock(0)->GetNumberOfElements(vtkDataObject::POINT),
    2 * levels->GetBlock(1)->GetNumberOfElements(vtkDataObject::POINT));
  filter->SetCoarsestLevel(1);
  filter->SetFinestLevel(1);
  filter->Update();
  ExpectSurfaceOfLevel(filter, 1);
  EXPECT_FALSE(SurfaceAt(filter, 2));
}

TEST(DeformableSurfaceOutputs, WritesARowOfHistoryPerIteration)
{
  const auto image = BallImage(40, 40, 40);
  image->SetSpacing(3.0, 3.0, 3.0);
  const auto filter = SurfaceOf(image);
  vtkTable* history = filter->GetHistory();
  const char* columns[] = { "Iteration", "Level", "Vertices", "KineticEnergy", "MeanEdgeLength",
    "Seconds", "TimeStep", "ActiveVertices", "Merges", "Cuts", "Splits", "Collapses", "Flips",
    "EulerCharacteristic", "Components" };
  ASSERT_EQ(history->GetNumberOfColumns(), 15);
  for (int c = 0; c < 15; ++c)
  {
    EXPECT_STREQ(history->GetColumnName(c), columns[c]);
  }
  int iterations = 0;
  for (unsigned int h = 0; h < 3; ++h)
  {
    iterations += static_cast<int>(FieldOf(SurfaceAt(filter, h), "Iterations"));
  }
  ASSERT_EQ(history->GetNumberOfRows(), iterations);
  for (vtkIdType r = 0; r < iterations; ++r)
  {
    EXPECT_EQ(history->GetValueByName(r, "Iteration").ToInt(), r + 1);
    const int level = history->GetValueByName(r, "Level").ToInt();
    auto* surface = SurfaceAt(filter, level);
    const double delta = FieldOf(surface, "Delta");
    EXPECT_GT(history->GetValueByName(r, "MeanEdgeLength").ToDouble(), delta);
    EXPECT_LT(history->GetValueByName(r, "MeanEdgeLength").ToDouble(), 2.5 * delta);
  }
  EXPECT_GT(history->GetValueByName(0, "KineticEnergy").ToDouble(), 0.0);
  EXPECT_EQ(history->GetValueByName(0, "Level").ToInt(), 2);
}

TEST(DeformableSurfaceOutputs, HasSnapshots)
{
  const auto plain = SurfaceOf(BallImage(40, 40, 40));
  const auto filter =
    SurfaceOf(BallImage(40, 40, 40), [](vtkDeformableSurface* f) { f->SetSnapshotInterval(20); });
  EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), plain->GetOutput()))
    << "looking on does not disturb";

  vtkMultiBlockDataSet* snapshots = filter->GetSnapshots();
  std::vector<std::string> expected;
  for (int level = 2; level >= 0; --level)
  {
    const double iterations = FieldOf(SurfaceAt(filter, level), "Iterations");
    for (int iteration = 0; iteration <= iterations; iteration += 20)
    {
      expected.push_back(
        "Level " + std::to_string(level) + ", iteration " + std::to_string(iteration));
    }
  }
  ASSERT_EQ(snapshots->GetNumberOfBlocks(), expected.size());
  int last = -1;
  for (unsigned int b = 0; b < expected.size(); ++b)
  {
    EXPECT_EQ(snapshots->GetMetaData(b)->Get(vtkCompositeDataSet::NAME()), expected[b]);
    auto* surface = vtkPolyData::SafeDownCast(snapshots->GetBlock(b));
    ASSERT_TRUE(surface);
    EXPECT_TRUE(surface->GetPointData()->GetNormals());
    EXPECT_EQ(StopReason(surface), "");
    const int iteration = static_cast<int>(FieldOf(surface, "Iteration"));
    EXPECT_GE(iteration, last);
    last = iteration;
    if (FieldOf(surface, "Iterations") > 0)
    {
      // The last row of a level describes its surface.
      const vtkVariant next = filter->GetHistory()->GetValueByName(iteration, "Level");
      EXPECT_TRUE(next.ToInt() != FieldOf(surface, "Level") ||
        filter->GetHistory()->GetValueByName(iteration - 1, "Vertices").ToInt() ==
          surface->GetNumberOfPoints());
      EXPECT_EQ(filter->GetHistory()->GetValueByName(iteration - 1, "Level").ToInt(),
        FieldOf(surface, "Level"));
    }
  }
}
