// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTestTools.h"
#include "vtkDeformableSurface.h"
#include "vtkImagePyramid.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMassProperties.h>
#include <vtkMath.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

using namespace volumic;

namespace
{
vtkSmartPointer<vtkDeformableSurface> SurfaceOf(vtkDataObject* input)
{
  auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
  filter->SetInputDataObject(input);
  filter->SetIsoValue(50.0);
  filter->Update();
  return filter;
}

double FieldOf(vtkPolyData* surface, const char* name, int i = 0)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array
    ? array->GetComponent(i / array->GetNumberOfComponents(), i % array->GetNumberOfComponents())
    : std::nan("");
}

std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}

double EnclosedVolume(vtkPolyData* surface)
{
  // Signed, unlike vtkMassProperties: negative if the triangles look inward.
  double volume = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkIdType size;
    const vtkIdType* ids;
    surface->GetCellPoints(c, size, ids);
    double p[3][3];
    for (int corner = 0; corner < 3; ++corner)
    {
      surface->GetPoint(ids[corner], p[corner]);
    }
    double cross[3];
    vtkMath::Cross(p[1], p[2], cross);
    volume += vtkMath::Dot(p[0], cross) / 6.0;
  }
  return volume;
}

int OpenOrNonManifoldEdges(vtkPolyData* surface)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->Update();
  return static_cast<int>(edges->GetOutput()->GetNumberOfCells());
}

void ExpectSphere(vtkPolyData* surface, const double* centre, double radius, double tolerance)
{
  ASSERT_GT(surface->GetNumberOfPoints(), 100);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double* p = surface->GetPoint(i);
    EXPECT_NEAR(std::sqrt(vtkMath::Distance2BetweenPoints(p, centre)), radius, tolerance);
    const double outward[3] = { p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] };
    const double* normal = surface->GetPointData()->GetNormals()->GetTuple(i);
    EXPECT_GT(vtkMath::Dot(normal, outward), 0.9 * radius) << "normals point outward";
  }
  EXPECT_NEAR(EnclosedVolume(surface), 4. / 3. * vtkMath::Pi() * std::pow(radius, 3),
    0.03 * 4. * std::pow(radius, 3));
}

bool AreSameSurfaces(vtkPolyData* a, vtkPolyData* b)
{
  if (a->GetNumberOfPoints() != b->GetNumberOfPoints() ||
    a->GetNumberOfCells() != b->GetNumberOfCells())
  {
    return false;
  }
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    double p[3];
    double q[3];
    a->GetPoint(i, p);
    b->GetPoint(i, q);
    if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2])
    {
      return false;
    }
  }
  return true;
}

const double BallCentre[3] = { 19.5, 19.5, 19.5 };
const double BallRadius = 0.3 * 40;
}

TEST(DeformableSurface, FindsABallInAnImage)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
  EXPECT_EQ(StopReason(filter->GetOutput()), "converged");
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 0);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Genus"), 0);
  EXPECT_EQ(FieldOf(filter->GetOutput(), "EulerCharacteristic"), 2);
}

TEST(DeformableSurface, AnImageGivesWhatItsPyramidGives)
{
  const auto image = BallImage(40, 40, 40);
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(image);
  pyramid->Update();
  const auto fromPyramid = SurfaceOf(pyramid->GetOutput());
  const auto fromImage = SurfaceOf(image);
  ASSERT_GT(fromImage->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(AreSameSurfaces(fromPyramid->GetOutput(), fromImage->GetOutput()));
}

TEST(DeformableSurface, CarriesTheArraysOfTheInterface)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  vtkPolyData* surface = filter->GetOutput();
  vtkPointData* points = surface->GetPointData();
  ASSERT_TRUE(points->GetNormals());
  EXPECT_STREQ(points->GetNormals()->GetName(), "Normals");
  EXPECT_EQ(points->GetNormals()->GetDataType(), VTK_FLOAT);
  ASSERT_TRUE(points->GetArray("Residual"));
  double range[2];
  points->GetArray("Residual")->GetRange(range);
  EXPECT_LT(std::max(-range[0], range[1]), 5.0) << "vertices lie on the isopotential";
  ASSERT_TRUE(points->GetArray("Motionless"));
  EXPECT_EQ(points->GetArray("Motionless")->GetDataType(), VTK_UNSIGNED_CHAR);
  ASSERT_TRUE(surface->GetCellData()->GetArray("Component"));
  EXPECT_EQ(surface->GetCellData()->GetArray("Component")->GetDataType(), VTK_INT);
  EXPECT_EQ(surface->GetCellData()->GetArray("Component")->GetNumberOfTuples(),
    surface->GetNumberOfCells());
  for (const char* name : { "Level", "Delta", "Unit", "NumberOfComponents", "EulerCharacteristic",
         "Genus", "Area", "Volume", "Iterations", "ComponentArea", "ComponentVolume",
         "ComponentGenus", "ComponentCentroid", "ComponentInertia" })
  {
    EXPECT_TRUE(surface->GetFieldData()->GetArray(name)) << name;
  }
  EXPECT_NEAR(FieldOf(surface, "Unit"), 1.0, 1e-12);
  EXPECT_NEAR(FieldOf(surface, "Delta"), filter->GetSamplingRatio(), 1e-6);
  EXPECT_NEAR(FieldOf(surface, "Volume"), EnclosedVolume(surface), 1e-6 * EnclosedVolume(surface));
}

TEST(DeformableSurface, FeaturesAreThoseOfABall)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
  vtkPolyData* surface = filter->GetOutput();
  const double volume = FieldOf(surface, "ComponentVolume");
  const double r2 = BallRadius * BallRadius;
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(FieldOf(surface, "ComponentCentroid", axis), 19.5, 0.05);
    EXPECT_NEAR(FieldOf(surface, "ComponentInertia", axis) / volume, 0.4 * r2, 0.02 * r2);
    EXPECT_NEAR(FieldOf(surface, "ComponentInertia", 3 + axis) / volume, 0.0, 0.01 * r2);
  }
  EXPECT_NEAR(FieldOf(surface, "ComponentArea"), 4 * vtkMath::Pi() * r2, 0.1 * r2);
}

TEST(DeformableSurface, KeepsTheSurfaceOfEveryLevel)
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
}

TEST(DeformableSurface, VisitsTheChosenLevelsOnly)
{
  const auto image = BallImage(40, 40, 40);
  const auto filter = SurfaceOf(image);
  filter->SetCoarsestLevel(1);
  filter->SetFinestLevel(1);
  filter->Update();
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 1);
  EXPECT_FALSE(filter->GetLevels()->GetBlock(0));
  EXPECT_TRUE(filter->GetLevels()->GetBlock(1));
  EXPECT_FALSE(filter->GetLevels()->GetBlock(2));
}

TEST(DeformableSurface, WritesARowOfHistoryPerIteration)
{
  const auto filter = SurfaceOf(BallImage(40, 40, 40));
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
    iterations += static_cast<int>(
      FieldOf(vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(h)), "Iterations"));
  }
  ASSERT_EQ(history->GetNumberOfRows(), iterations);
  for (vtkIdType r = 0; r < iterations; ++r)
  {
    EXPECT_EQ(history->GetValueByName(r, "Iteration").ToInt(), r + 1);
    EXPECT_GT(history->GetValueByName(r, "Vertices").ToInt(), 0);
    EXPECT_GT(history->GetValueByName(r, "TimeStep").ToDouble(), 0.0);
    const int level = history->GetValueByName(r, "Level").ToInt();
    auto* surface = vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(level));
    const double delta = FieldOf(surface, "Delta");
    EXPECT_GT(history->GetValueByName(r, "MeanEdgeLength").ToDouble(), delta);
    EXPECT_LT(history->GetValueByName(r, "MeanEdgeLength").ToDouble(), 2.5 * delta);
    EXPECT_GE(history->GetValueByName(r, "KineticEnergy").ToDouble(), 0.0);
    EXPECT_GE(history->GetValueByName(r, "Seconds").ToDouble(), 0.0);
    EXPECT_EQ(history->GetValueByName(r, "EulerCharacteristic").ToInt(), 2);
    EXPECT_EQ(history->GetValueByName(r, "Components").ToInt(), 1);
  }
  EXPECT_GT(history->GetValueByName(0, "KineticEnergy").ToDouble(), 0.0);
  EXPECT_EQ(history->GetValueByName(0, "Level").ToInt(), 2);
  EXPECT_EQ(history->GetValueByName(iterations - 1, "Level").ToInt(), 0);
}

TEST(DeformableSurface, ComesBackToWorldCoordinates)
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

TEST(DeformableSurface, IsOutwardInAMirroredImageToo)
{
  const auto image = BallImage(40, 40, 40);
  const double mirror[9] = { -1, 0, 0, 0, 1, 0, 0, 0, 1 };
  image->SetDirectionMatrix(mirror);
  const double centre[3] = { -19.5, 19.5, 19.5 };
  ExpectSphere(SurfaceOf(image)->GetOutput(), centre, BallRadius, 0.2);
}

TEST(DeformableSurface, FollowsAnisotropicVoxels)
{
  const auto image = BallImage(40, 40, 40);
  image->SetSpacing(1, 1, 2.5);
  const auto filter = SurfaceOf(image);
  vtkPolyData* surface = filter->GetOutput();
  ASSERT_GT(surface->GetNumberOfPoints(), 100);
  double bounds[6];
  surface->GetBounds(bounds);
  EXPECT_NEAR(bounds[1] - bounds[0], 2 * BallRadius, 0.6);
  EXPECT_NEAR(bounds[5] - bounds[4], 2.5 * 2 * BallRadius, 1.5);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_EQ(FieldOf(surface, "Genus"), 0);
}

TEST(DeformableSurface, FindsDarkObjects)
{
  const auto image = BallImage(40, 40, 40);
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < voxels->GetNumberOfTuples(); ++i)
  {
    voxels->SetComponent(i, 0, 100.0 - voxels->GetComponent(i, 0));
  }
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(image);
  filter->SetIsoValue(50.0);
  filter->ObjectIsBrightOff();
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
}

TEST(DeformableSurface, StartsFromTheIsoSurface)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  filter->SetInitializationToIsoSurface();
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
  const auto enclosing = SurfaceOf(BallImage(40, 40, 40));
  EXPECT_LT(FieldOf(vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(2)), "Iterations"),
    FieldOf(vtkPolyData::SafeDownCast(enclosing->GetLevels()->GetBlock(2)), "Iterations"));
}

TEST(DeformableSurface, StartsFromSeeds)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  filter->SetInitializationToSeeds();
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);

  vtkNew<vtkPoints> points;
  points->InsertNextPoint(21, 18, 20);
  vtkNew<vtkPolyData> seeds;
  seeds->SetPoints(points);
  filter->SetInitialSurfaceData(seeds);
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
}

TEST(DeformableSurface, StartsFromAGivenSurface)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(22, 19, 19);
  sphere->SetRadius(14);
  sphere->SetThetaResolution(24);
  sphere->SetPhiResolution(20);
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  filter->SetInitializationToInputSurface();
  filter->SetInitialSurfaceConnection(sphere->GetOutputPort());
  filter->Update();
  ExpectSphere(filter->GetOutput(), BallCentre, BallRadius, 0.2);
}

TEST(DeformableSurface, ClosesAtTheBorderOfTheImage)
{
  const auto image = BallImage(40, 40, 40, 0.6);
  const auto filter = SurfaceOf(image);
  vtkPolyData* surface = filter->GetOutput();
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  double bounds[6];
  surface->GetBounds(bounds);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(bounds[2 * axis], -0.5, 0.6);
    EXPECT_NEAR(bounds[2 * axis + 1], 39.5, 0.6);
  }
}

TEST(DeformableSurface, IsTheSameBitsForAnyNumberOfThreadsAndAnyRun)
{
  const auto image = BallImage(48, 48, 48);
  vtkNew<vtkDeformableSurface> one;
  one->SetInputData(image);
  one->SetIsoValue(50.0);
  one->SetNumberOfThreads(1);
  one->Update();
  for (const int threads : { 1, 2, 3 })
  {
    vtkNew<vtkDeformableSurface> other;
    other->SetInputData(image);
    other->SetIsoValue(50.0);
    other->SetNumberOfThreads(threads);
    other->Update();
    ASSERT_GT(other->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(AreSameSurfaces(other->GetOutput(), one->GetOutput())) << threads << " threads";
  }
}

TEST(DeformableSurface, StopsAtTheIterationLimit)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallImage(40, 40, 40));
  filter->SetIsoValue(50.0);
  filter->SetMaximumNumberOfIterations(3);
  filter->Update();
  EXPECT_EQ(StopReason(filter->GetOutput()), "iteration limit");
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Iterations"), 3);
  EXPECT_EQ(OpenOrNonManifoldEdges(filter->GetOutput()), 0);
}

namespace
{
/// The ball, and a rod beside it that is too thin for the coarse levels.
vtkSmartPointer<vtkImageData> BallAndRod()
{
  const auto image = BallImage(64, 64, 64, 0.25);
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  for (int k = 8; k < 56; ++k)
  {
    for (int j = 6; j < 9; ++j)
    {
      for (int i = 6; i < 9; ++i)
      {
        voxels->SetComponent((k * 64 + j) * 64 + i, 0, 100.0);
      }
    }
  }
  return image;
}
}

TEST(DeformableSurface, FindsAgainWhatCoarseLevelsLose)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallAndRod());
  filter->SetIsoValue(50.0);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 2);
  double recovered = 0;
  for (unsigned int h = 0; h < filter->GetLevels()->GetNumberOfBlocks(); ++h)
  {
    recovered +=
      FieldOf(vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(h)), "RecoveredParts");
  }
  EXPECT_EQ(recovered, 1);
  EXPECT_EQ(warnings.Get(), "");
}

TEST(DeformableSurface, WarnsOfWhatStaysLostAndNamesTheLevel)
{
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(BallAndRod());
  filter->SetIsoValue(50.0);
  filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_EQ(FieldOf(filter->GetOutput(), "NumberOfComponents"), 1);
  EXPECT_TRUE(warnings.Has("1 part of the object that the surface lost at level"))
    << warnings.Get();
  EXPECT_TRUE(warnings.Has("Turn Recovery on")) << warnings.Get();
}

TEST(DeformableSurface, PrintsItsProperties)
{
  vtkNew<vtkDeformableSurface> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* property :
    { "IsoValue: nan", "ObjectIsBright: 1", "Initialization: 0", "CoarsestLevel: -1",
      "FinestLevel: 0", "GradientWeight: 0", "BorderValue: 0", "TopologyChanges: 1",
      "MaximumNumberOfIterations: 1000", "SnapToIsoValue: 1", "NumberOfThreads: 0" })
  {
    EXPECT_NE(text.str().find(property), std::string::npos) << property;
  }
}
