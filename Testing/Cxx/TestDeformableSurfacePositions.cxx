// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

using namespace volumic;

namespace
{
/**
 * Two balls of radius 7.5 about (12.5, 12.5, 12.5) and (37.5, 12.5, 12.5), spacing 1, from (100, 0,
 * 0) on.
 */
vtkSmartPointer<vtkImageData> TwoBalls()
{
  auto image = ImageOf({ 50, 25, 25 },
    [](int i, int j, int k)
    {
      const double distance = std::hypot(std::abs(i - 25.0) - 12.5, j - 12.5, k - 12.6) - 7.5;
      return std::clamp(50.0 - 50.0 * distance, 0.0, 100.0);
    });
  image->SetOrigin(100, 0, 0);
  return image;
}

/** A ball of radius 16 about the middle, and two rods beside it, too thin for the coarse levels. */
vtkSmartPointer<vtkImageData> BallAndRods()
{
  const auto image = BallImage(64, 64, 64, 0.25);
  FillBox(image, { 6, 6, 8 }, { 9, 9, 56 });
  FillBox(image, { 55, 55, 8 }, { 58, 58, 56 });
  return image;
}

const std::array<double, 3> InLeft = { 112, 12, 13 };
const std::array<double, 3> InRight = { 138, 13, 12 };

class DeformableSurfacePositions : public ::testing::Test
{
protected:
  static vtkSmartPointer<vtkDeformableSurface> NewFilter()
  {
    return FilterOf(TwoBalls(),
      [](vtkDeformableSurface* f) { f->SetRecovery(vtkDeformableSurface::NoRecovery); });
  }

  void AddSeed(const std::array<double, 3>& p) { this->Filter->AddSeedPosition(p[0], p[1], p[2]); }

  double Components()
  {
    this->Filter->Update();
    return FieldOf(this->Filter->GetOutput(), "NumberOfComponents");
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Filter->Modified();
    ExpectErrorOf(this->Filter, parts);
  }

  const vtkSmartPointer<vtkDeformableSurface> Filter = NewFilter();
  const vtkSmartPointer<vtkDeformableSurface> Other = NewFilter();
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

TEST_F(DeformableSurfacePositions, SeedsAreTestedAtLevel0)
{
  const double ofRod = 3 * 3 * 48;
  this->Filter->SetInputDataObject(BallAndRods());
  this->Filter->SetRecovery(vtkDeformableSurface::RecoverObjects);
  this->Filter->SetInitializationToSeeds();
  this->AddSeed({ 7, 7, 30 });
  ASSERT_EQ(this->Components(), 1);
  vtkPolyData* surface = this->Filter->GetOutput();
  EXPECT_LT(surface->GetBounds()[1], 12) << "only what has a seed";
  EXPECT_NEAR(FieldOf(surface, "Volume") / ofRod, 1.0, 0.2) << "its edges are rounded";
  const int start = static_cast<int>(FieldOf(surface, "StartLevel"));
  const int last = static_cast<int>(this->Filter->GetLevels()->GetNumberOfBlocks()) - 1;
  ASSERT_LT(start, last);
  EXPECT_FALSE(this->Filter->GetLevels()->GetBlock(static_cast<unsigned int>(start) + 1));
  // The result does not depend on the level at which the run starts.
  const double volume = FieldOf(surface, "Volume");
  for (int level = 0; level <= start; ++level)
  {
    SCOPED_TRACE(level);
    this->Filter->SetCoarsestLevel(level);
    EXPECT_EQ(this->Components(), 1);
    EXPECT_LT(SurfaceAt(this->Filter, level)->GetBounds()[1], 12);
    EXPECT_NEAR(FieldOf(surface, "Volume") / volume, 1.0, 0.03);
    EXPECT_EQ(FieldOf(surface, "StartLevel"), level);
  }
  // With recovery one seed, here in the ball, suffices for a start.
  this->Filter->SetCoarsestLevel(last);
  this->ExpectError({ "Coarsest Level is " + std::to_string(last), "too thin at 1 of 1 seeds",
    "Set it to " + std::to_string(start) + " or less" });
  this->AddSeed({ 32, 32, 32 });
  EXPECT_EQ(this->Components(), 2);
  this->Filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  this->ExpectError({ "Coarsest Level", "too thin at 1 of 2 seeds" });
  this->Filter->SetCoarsestLevel(-1);
  this->Filter->SetFinestLevel(last);
  this->ExpectError({ "Finest Level is " + std::to_string(last), "too thin at 1 of 2 seeds" });
}

TEST_F(DeformableSurfacePositions, SelectionsAreAmongTheComponentsAtSeeds)
{
  this->Filter->SetRecovery(vtkDeformableSurface::RecoverObjects);
  this->Filter->SetInputDataObject(BallAndRods());
  this->Filter->SetInitializationToSeeds();
  this->AddSeed({ 7, 7, 30 });
  this->AddSeed({ 56, 56, 30 });
  this->Filter->SetSnapshotInterval(20);
  this->Filter->SetKeepComponentsToLargestComponent();
  EXPECT_EQ(this->Components(), 1) << "not the ball";
  EXPECT_LT(FieldOf(this->Filter->GetOutput(), "Volume"), 1000);
  vtkMultiBlockDataSet* snapshots = this->Filter->GetSnapshots();
  for (unsigned int i = 0; i < snapshots->GetNumberOfBlocks(); ++i)
  {
    EXPECT_LE(FieldOf(vtkPolyData::SafeDownCast(snapshots->GetBlock(i)), "NumberOfComponents"), 2);
  }
  this->Filter->SetKeepComponentsToComponentsNotAtSeeds();
  EXPECT_TRUE(
    Has(MessagesOfUpdate(this->Filter, vtkCommand::WarningEvent), "Keep Components selects none"));
}

TEST_F(DeformableSurfacePositions, UsesSeedsOfThePortAndOfTheList)
{
  this->Filter->SetInitializationToSeeds();
  this->Filter->SetInitialSurfaceData(PointsAt({ InLeft }));
  this->AddSeed(InRight);
  EXPECT_EQ(this->Components(), 2);
  this->Other->SetInitializationToSeeds();
  this->Other->SetInitialSurfaceData(PointsAt({ InLeft, InRight }));
  this->Other->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), this->Other->GetOutput()));
}

TEST_F(DeformableSurfacePositions, PositionsAttractLikePointsOfThePort)
{
  const std::array<double, 3> beside = { 112.5, 21.5, 12.5 };
  this->Filter->Update();
  const double top = this->Filter->GetOutput()->GetBounds()[3];
  this->Filter->AddAttractingPosition(beside[0], beside[1], beside[2]);
  this->Filter->Update();
  EXPECT_GT(this->Filter->GetOutput()->GetBounds()[3], top + 1);
  this->Other->SetAttractingPointsData(PointsAt({ beside }));
  this->Other->Update();
  EXPECT_TRUE(AreSameSurfaces(this->Filter->GetOutput(), this->Other->GetOutput()));
  this->Filter->SetPointAttractionWeight(0.0);
  this->Filter->Update();
  EXPECT_NEAR(this->Filter->GetOutput()->GetBounds()[3], top, 0.3);
}

TEST_F(DeformableSurfacePositions, BothListsSelectComponents)
{
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  EXPECT_EQ(this->Components(), 2) << "all, without points";
  this->AddSeed(InLeft);
  EXPECT_EQ(this->Components(), 1);
  EXPECT_LT(this->Filter->GetOutput()->GetBounds()[1], 125);
  this->Filter->AddAttractingPosition(InRight[0], InRight[1], InRight[2]);
  EXPECT_EQ(this->Components(), 2);
}

TEST_F(DeformableSurfacePositions, ReportsPositionsOutsideTheImageOrTheObject)
{
  this->Filter->SetInitializationToSeeds();
  this->AddSeed(InLeft);
  this->Filter->AddSeedPosition(12, 12, 13);
  this->ExpectError({ "Seed Positions: point 1 (12, 12, 13) is outside the image", "Move it" });
  this->Filter->ClearSeedPositions();
  this->Filter->AddSeedPosition(std::numeric_limits<double>::quiet_NaN(), 12, 13);
  this->ExpectError({ "Seed Positions: point 0" });
  this->Filter->ClearSeedPositions();
  this->Filter->AddSeedPosition(125, 2, 2);
  this->ExpectError({ "Seed Positions: the seed is not inside the object", "above Iso Value 50",
    "the value at the seed is 0. Move it" });
  this->Filter->ClearSeedPositions();
  this->Filter->AddAttractingPosition(12, 12, 13);
  this->ExpectError({ "Attracting Positions: point 0 (12, 12, 13) is outside the image" });
}

TEST_F(DeformableSurfacePositions, PositionsOnTheBorderAreInside)
{
  this->Filter->SetInitializationToSeeds();
  this->AddSeed(InLeft);
  this->Filter->AddSeedPosition(100 - 1e-6, 25 + 1e-6, 12);
  EXPECT_EQ(this->Components(), 1) << "the other is left out, as it is not in the object";
}

TEST_F(DeformableSurfacePositions, ListsCanBeRead)
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
