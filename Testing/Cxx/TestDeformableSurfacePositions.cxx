// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
using Places = std::vector<std::array<double, 3>>;

/**
 * Two balls of radius 7.5 about (12.5, 12.5, 12.5) and (37.5, 12.5, 12.5), spacing 1, from (100, 0,
 * 0) on.
 */
vtkSmartPointer<vtkImageData> TwoBalls()
{
  auto image = BallImage(50, 25, 25);
  image->SetOrigin(100, 0, 0);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const double* p = image->GetPoint(i);
    const double x = std::abs(p[0] - 125.0) - 12.5;
    const double distance = std::hypot(x, p[1] - 12.5, p[2] - 12.6) - 7.5;
    Voxels(image)->SetComponent(i, 0, std::max(0.0, std::min(100.0, 50.0 - 50.0 * distance)));
  }
  return image;
}

const std::array<double, 3> InLeft = { 112, 12, 13 };
const std::array<double, 3> InRight = { 138, 13, 12 };

class DeformableSurfacePositions : public ::testing::Test
{
protected:
  void SetUp() override { this->Reset(this->Filter); }

  static void Reset(vtkDeformableSurface* filter)
  {
    filter->SetInputDataObject(TwoBalls());
    filter->SetIsoValue(50.0);
    filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  }

  void AddSeed(const std::array<double, 3>& p)
  {
    this->Filter->AddSeedPosition(p[0], p[1], p[2]);
  }

  double Components()
  {
    this->Filter->Update();
    return FieldOf(this->Filter->GetOutput(), "NumberOfComponents");
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Filter->Modified();
    ExpectErrorOf(this->Filter, parts);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  }

  vtkNew<vtkDeformableSurface> Filter;
  vtkNew<vtkDeformableSurface> Other;
};
}

TEST_F(DeformableSurfacePositions, SeedsGrowWhereTheyAreSet)
{
  this->Filter->SetInitializationToSeeds();
  EXPECT_EQ(this->Components(), 2) << "on a grid";
  this->AddSeed(InLeft);
  EXPECT_EQ(this->Components(), 1);
  EXPECT_LT(this->Filter->GetOutput()->GetBounds()[1], 125);
  this->AddSeed(InRight);
  EXPECT_EQ(this->Components(), 2);
  this->Filter->ClearSeedPositions();
  this->AddSeed(InRight);
  EXPECT_EQ(this->Components(), 1);
  EXPECT_GT(this->Filter->GetOutput()->GetBounds()[0], 125);
}

TEST_F(DeformableSurfacePositions, SeedsAreThoseOfThePortAndOfTheList)
{
  this->Filter->SetInitializationToSeeds();
  this->Filter->SetInitialSurfaceData(PointsAt({ InLeft }));
  this->AddSeed(InRight);
  EXPECT_EQ(this->Components(), 2);
  this->Reset(this->Other);
  this->Other->SetInitializationToSeeds();
  this->Other->SetInitialSurfaceData(PointsAt({ InLeft, InRight }));
  this->Other->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), this->Other->GetOutput()));
}

TEST_F(DeformableSurfacePositions, PointsAttractAsThoseOfThePortDo)
{
  const std::array<double, 3> beside = { 112.5, 21.5, 12.5 };
  this->Filter->Update();
  const double top = this->Filter->GetOutput()->GetBounds()[3];
  this->Filter->AddAttractingPosition(beside[0], beside[1], beside[2]);
  this->Filter->Update();
  EXPECT_GT(this->Filter->GetOutput()->GetBounds()[3], top + 1);
  this->Reset(this->Other);
  this->Other->SetAttractingPointsData(PointsAt({ beside }));
  this->Other->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), this->Other->GetOutput()));
  this->Filter->SetPointAttractionWeight(0.0);
  this->Filter->Update();
  EXPECT_NEAR(this->Filter->GetOutput()->GetBounds()[3], top, 0.3);
}

TEST_F(DeformableSurfacePositions, BothListsChooseComponents)
{
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  EXPECT_EQ(this->Components(), 2) << "all, without points";
  this->AddSeed(InLeft);
  EXPECT_EQ(this->Components(), 1);
  EXPECT_LT(this->Filter->GetOutput()->GetBounds()[1], 125);
  this->Filter->AddAttractingPosition(InRight[0], InRight[1], InRight[2]);
  EXPECT_EQ(this->Components(), 2);
}

TEST_F(DeformableSurfacePositions, OnesOutsideTheImageAreRefused)
{
  this->Filter->SetInitializationToSeeds();
  this->AddSeed(InLeft);
  this->Filter->AddSeedPosition(12, 12, 13);
  this->ExpectError({ "Seed Positions: point 1 (12, 12, 13) lies outside the image", "move it" });
  this->Filter->ClearSeedPositions();
  this->Filter->AddSeedPosition(std::numeric_limits<double>::quiet_NaN(), 12, 13);
  this->ExpectError({ "Seed Positions: point 0" });
  this->Filter->ClearSeedPositions();
  this->Filter->AddAttractingPosition(12, 12, 13);
  this->ExpectError({ "Attracting Positions: point 0 (12, 12, 13) lies outside the image" });
}

TEST_F(DeformableSurfacePositions, OnesPickedOnTheBorderAreInside)
{
  this->Filter->SetInitializationToSeeds();
  this->AddSeed(InLeft);
  this->Filter->AddSeedPosition(100 - 1e-6, 25 + 1e-6, 12);
  EXPECT_EQ(this->Components(), 1) << "the other is left out, as it is not in the object";
}

TEST_F(DeformableSurfacePositions, SeedsOutsideTheObjectAreNamedAsThePanelDoes)
{
  this->Filter->SetInitializationToSeeds();
  this->Filter->AddSeedPosition(125, 2, 2);
  this->ExpectError({ "Seed Positions: The seed does not lie inside the object" });
}

TEST_F(DeformableSurfacePositions, ListsAreKept)
{
  EXPECT_EQ(this->Filter->GetNumberOfSeedPositions(), 0);
  this->AddSeed(InLeft);
  const vtkMTimeType before = this->Filter->GetMTime();
  this->Filter->AddSeedPosition(0.1, 1e9 + 0.25, -3);
  EXPECT_GT(this->Filter->GetMTime(), before);
  this->Filter->AddAttractingPosition(1, 2, 3);
  ASSERT_EQ(this->Filter->GetNumberOfSeedPositions(), 2);
  ASSERT_EQ(this->Filter->GetNumberOfAttractingPositions(), 1);
  double p[3];
  this->Filter->GetSeedPosition(1, p);
  EXPECT_EQ(p[0], 0.1);
  EXPECT_EQ(p[1], 1e9 + 0.25);
  this->Filter->GetAttractingPosition(0, p);
  EXPECT_EQ(p[2], 3);
  this->Filter->GetAttractingPosition(1, p);
  EXPECT_TRUE(std::isnan(p[0]));
  this->Filter->ClearAttractingPositions();
  EXPECT_EQ(this->Filter->GetNumberOfAttractingPositions(), 0);
  EXPECT_EQ(this->Filter->GetNumberOfSeedPositions(), 2);
}
