// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>

using namespace volumic;

namespace
{
/** A ball of radius 9.6 about (15.5, 15.5, 15.5), and points to attract its surface. */
class DeformableSurfaceAttraction : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Points->SetPoints(vtkNew<vtkPoints>());
    this->Filter->SetAttractingPointsData(this->Points);
  }

  template <typename Array>
  void SetArray(const char* name, const std::vector<double>& values)
  {
    vtkNew<Array> array;
    array->SetName(name);
    for (const double value : values)
    {
      array->InsertNextValue(value);
    }
    this->Points->GetPointData()->AddArray(array);
  }

  /** By how much the surface reaches beyond the ball along +x. */
  double Bump()
  {
    this->Filter->Update();
    return this->Filter->GetOutput()->GetBounds()[1] - (15.5 + 9.6);
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Filter->Modified();
    ExpectErrorOf(this->Filter, parts);
  }

  vtkNew<vtkPolyData> Points;
  const vtkSmartPointer<vtkDeformableSurface> Filter = FilterOf(BallImage(32, 32, 32));
};
}

TEST_F(DeformableSurfaceAttraction, PointsAttractTheSurfaceByRadiusAndWeight)
{
  EXPECT_NEAR(this->Bump(), 0.0, 0.3) << "no points, no bump";
  this->Points->GetPoints()->InsertNextPoint(26.5, 15.5, 15.5);
  this->SetArray<vtkIntArray>("Weight", { 1 });
  this->Points->Modified();
  const double automatic = this->Bump();
  EXPECT_GT(automatic, 1.4) << "the point is inside";
  EXPECT_LT(automatic, 4.5);
  this->SetArray<vtkDoubleArray>("Radius", { 4.0 });
  this->Points->Modified();
  EXPECT_GT(this->Bump(), automatic + 1.0);
  this->SetArray<vtkDoubleArray>("Weight", { 0.0 });
  this->Points->Modified();
  EXPECT_NEAR(this->Bump(), 0.0, 0.3);
}

TEST_F(DeformableSurfaceAttraction, UsesVerticesIfThereAreAny)
{
  this->Points->GetPoints()->InsertNextPoint(26.5, 15.5, 15.5);
  this->Points->GetPoints()->InsertNextPoint(15.5, 15.5, 26.5);
  this->Points->SetVerts(vtkNew<vtkCellArray>());
  const vtkIdType id = 1;
  this->Points->GetVerts()->InsertNextCell(1, &id);
  EXPECT_NEAR(this->Bump(), 0.0, 0.3);
  EXPECT_GT(this->Filter->GetOutput()->GetBounds()[5], 15.5 + 9.6 + 1.4);
}

TEST_F(DeformableSurfaceAttraction, ReportsInvalidPoints)
{
  this->Points->GetPoints()->InsertNextPoint(16, 16, 40);
  this->ExpectError({ "Input port 2", "point 0", "outside the image" });
  this->Points->GetPoints()->SetPoint(0, 16, 16, 26);
  this->SetArray<vtkDoubleArray>("Weight", { -1.0 });
  this->ExpectError({ "Input port 2", "Weight of point 0 is -1" });
  this->SetArray<vtkDoubleArray>("Weight", { 1.0 });
  this->SetArray<vtkDoubleArray>("Radius", { std::numeric_limits<double>::infinity() });
  this->ExpectError({ "Input port 2", "Radius of point 0 is inf" });
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("Radius");
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(1);
  vectors->Fill(1.0);
  this->Points->GetPointData()->AddArray(vectors);
  this->ExpectError({ "Input port 2", "Radius", "one number per point" });
}

TEST_F(DeformableSurfaceAttraction, ReportsAMissingEdgeMap)
{
  this->Filter->SetEdgeAttractionWeight(1.0);
  this->ExpectError({ "Edge Attraction Weight", "SetInputArrayToProcess(1" });
  this->Filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Edges");
  this->ExpectError({ "Input port 0, edge map", "'Edges'" });
  this->Filter->SetEdgeAttractionWeight(0.0);
  this->Filter->Update();
  EXPECT_GT(this->Filter->GetOutput()->GetNumberOfPoints(), 100);
}
