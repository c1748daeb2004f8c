// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>

using namespace volumic;

namespace
{
/**
 * A hollow ball (radii 12 and 8) about (16, 16, 16) that holds a ball of radius 4, and beside it a
 * ball of radius 6 about (38, 16, 16).
 */
vtkSmartPointer<vtkImageData> HollowBallAndBall()
{
  return ImageOf({ 50, 32, 32 },
    [](int i, int j, int k)
    {
      const auto ball = [=](double x, double radius) // no voxel has the iso-value
      { return std::hypot(i - x - 0.13, j - 16.07, k - 15.91) - radius; };
      const double distance =
        std::min({ std::max(ball(16, 12), -ball(16, 8)), ball(16, 4), ball(38, 6) });
      return std::clamp(50.0 - 50.0 * distance, 0.0, 100.0);
    });
}

class DeformableSurfaceComponents : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Filter->SetCoarsestLevel(0);
    this->Filter->SetInitializationToIsoSurface();
  }

  /** Return the volumes of the output components in their order. */
  std::vector<double> Volumes()
  {
    this->Filter->Update();
    vtkPolyData* surface = this->Filter->GetOutput();
    EXPECT_TRUE(surface->GetFieldData()->HasArray("NumberOfComponents"));
    const int n = static_cast<int>(FieldOf(surface, "NumberOfComponents"));
    std::vector<double> volumes;
    double sum = 0;
    for (int c = 0; c < n; ++c)
    {
      volumes.push_back(FieldOf(surface, "ComponentVolume", c));
      sum += volumes.back();
    }
    EXPECT_EQ(surface->GetFieldData()->GetArray("ComponentArea")->GetNumberOfTuples(), n);
    EXPECT_NEAR(FieldOf(surface, "Volume"), sum, 1e-6);
    EXPECT_EQ(FieldOf(surface, "EulerCharacteristic"), 2 * n);
    EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
    if (n > 0)
    {
      EXPECT_EQ(surface->GetCellData()->GetArray("Component")->GetRange()[1], n - 1);
      ExpectFeaturesOfCells(surface);
      EXPECT_EQ(
        surface->GetPointData()->GetNormals()->GetNumberOfTuples(), surface->GetNumberOfPoints());
      EXPECT_NEAR(EnclosedVolume(surface), sum, 1e-6 * std::abs(sum));
    }
    EXPECT_EQ(SurfaceAt(this->Filter, 0)->GetNumberOfPoints(), surface->GetNumberOfPoints());
    return volumes;
  }

  /** Check that cell data and field data of the components agree. */
  static void ExpectFeaturesOfCells(vtkPolyData* surface)
  {
    vtkDataArray* component = surface->GetCellData()->GetArray("Component");
    const std::pair<const char*, int> features[] = { { "ComponentArea", VTK_FLOAT },
      { "ComponentVolume", VTK_FLOAT }, { "ComponentGenus", VTK_INT } };
    for (const auto& [name, type] : features)
    {
      vtkDataArray* array = surface->GetCellData()->GetArray(name);
      ASSERT_TRUE(array) << name;
      EXPECT_EQ(array->GetDataType(), type) << name;
      ASSERT_EQ(array->GetNumberOfTuples(), surface->GetNumberOfCells()) << name;
      for (vtkIdType t = 0; t < surface->GetNumberOfCells(); ++t)
      {
        const double expected =
          FieldOf(surface, name, static_cast<int>(component->GetComponent(t, 0)));
        ASSERT_NEAR(array->GetComponent(t, 0), expected, 1e-6 * std::abs(expected)) << name;
      }
    }
  }

  static void ExpectVolumes(const std::vector<double>& volumes, const std::vector<double>& expected)
  {
    ASSERT_EQ(volumes.size(), expected.size());
    for (std::size_t c = 0; c < expected.size(); ++c)
    {
      EXPECT_NEAR(volumes[c] / expected[c], 1.0, 0.08) << c;
    }
  }

  void SetSeed(double x, double y, double z)
  {
    this->Filter->SetInitialSurfaceData(PointsAt({ { x, y, z } }));
  }

  const vtkSmartPointer<vtkDeformableSurface> Filter = FilterOf(HollowBallAndBall());
  const double Outside = VolumeOfBall(12);
  const double Cavity = -VolumeOfBall(8);
  const double Beside = VolumeOfBall(6);
  const double Inner = VolumeOfBall(4);
};
}

TEST_F(DeformableSurfaceComponents, LargestHasItsCavity)
{
  this->Filter->SetKeepComponentsToLargestComponent();
  ExpectVolumes(this->Volumes(), { this->Outside, this->Cavity });
}

TEST_F(DeformableSurfaceComponents, CavitiesNameTheirOwner)
{
  ExpectVolumes(this->Volumes(), { this->Outside, this->Cavity, this->Beside, this->Inner });
  const auto owners = [this]
  {
    vtkDataArray* array = this->Filter->GetOutput()->GetFieldData()->GetArray("ComponentOwner");
    std::vector<double> found;
    for (vtkIdType c = 0; array && c < array->GetNumberOfTuples(); ++c)
    {
      found.push_back(array->GetComponent(c, 0));
    }
    return found;
  };
  EXPECT_EQ(owners(), (std::vector<double>{ 0, 0, 2, 3 }));
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  this->SetSeed(16, 16, 16);
  ExpectVolumes(this->Volumes(), { this->Inner });
  EXPECT_EQ(owners(), std::vector<double>{ 0 });
}

TEST_F(DeformableSurfaceComponents, PointsSelectTheInnermostEnclosingComponent)
{
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  this->SetSeed(38.3, 15.7, 16.2);
  ExpectVolumes(this->Volumes(), { this->Beside });
  this->SetSeed(16, 16, 16);
  ExpectVolumes(this->Volumes(), { this->Inner });
  this->SetSeed(6, 16, 16);
  ExpectVolumes(this->Volumes(), { this->Outside, this->Cavity });
  this->SetSeed(38, 16, 23);
  ExpectVolumes(this->Volumes(), { this->Beside });
  this->SetSeed(28.5, 27.0, 27.0);
  const MessagesOf warnings(this->Filter, vtkCommand::WarningEvent);
  EXPECT_TRUE(this->Volumes().empty());
  EXPECT_TRUE(Has(warnings.Get(), "surface of level 0 is empty: Keep Components"));
}

TEST_F(DeformableSurfaceComponents, SeedsRemoveMarkedComponents)
{
  this->Filter->SetKeepComponentsToComponentsNotAtSeeds();
  const std::vector<double> all{ this->Outside, this->Cavity, this->Beside, this->Inner };
  ExpectVolumes(this->Volumes(), all);
  this->Filter->SetPointAttractionWeight(0.0);
  this->Filter->AddAttractingPosition(38, 16, 16);
  ExpectVolumes(this->Volumes(), all);
  this->SetSeed(38.3, 15.7, 16.2);
  ExpectVolumes(this->Volumes(), { this->Outside, this->Cavity, this->Inner });
  this->Filter->AddSeedPosition(6, 16, 16);
  ExpectVolumes(this->Volumes(), { this->Inner });
}

TEST_F(DeformableSurfaceComponents, ReportsLinesAsSeeds)
{
  const auto line = PointsAt({ { 38, 16, 16 }, { 16, 16, 17 } });
  line->SetLines(vtkNew<vtkCellArray>());
  const vtkIdType ids[2] = { 0, 1 };
  line->GetLines()->InsertNextCell(2, ids);
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  this->Filter->SetInitialSurfaceData(line);
  ExpectErrorOf(this->Filter, { "Input port 1 (Initial Surface): ", "no vertices" });
  this->Filter->SetKeepComponentsToAllComponents();
  this->Filter->SetInitializationToSeeds();
  ExpectErrorOf(this->Filter, { "Input port 1 (Initial Surface): ", "no vertices" });
}

TEST_F(DeformableSurfaceComponents, SelectsByVolumesAndPositionsInWorldUnits)
{
  auto image = HollowBallAndBall();
  image->SetSpacing(0.5, -0.5, 1.5);
  image->SetOrigin(7, 8, 9);
  this->Filter->SetInputDataObject(image);
  this->Filter->SetKeepComponentsToComponentsAtPoints();
  this->SetSeed(7 + 0.5 * 38, 8 - 0.5 * 16, 9 + 1.5 * 16);
  const double voxel = 0.5 * 0.5 * 1.5;
  ExpectVolumes(this->Volumes(), { voxel * this->Beside });
  this->Filter->SetKeepComponentsToLargeComponents();
  this->Filter->SetMinimumComponentVolume(voxel * 600.0);
  ExpectVolumes(
    this->Volumes(), { voxel * this->Outside, voxel * this->Cavity, voxel * this->Beside });
  this->Filter->SetMinimumComponentVolume(voxel * 2000.0);
  ExpectVolumes(this->Volumes(), { voxel * this->Outside, voxel * this->Cavity });
}
