// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Tests of the interface mesh of vtkLabelsToSurfaces and of its blocks.

#include "LabelImages.h"
#include "SameOutputs.h"

#include <vtkCell.h>
#include <vtkCellArray.h>

using namespace volumic;

namespace
{
/** Two adjacent blocks, labels 3 and 7, a ball of label 5 in the first, one voxel of label 7. */
double TouchingBlocks(int i, int j, int k)
{
  if (i < 3 || i >= 25 || j < 3 || j >= 17 || k < 3 || k >= 17)
  {
    return i == 1 && j == 1 && k == 1 ? 7 : 0;
  }
  return std::hypot(i - 8., j - 10., k - 10.) < 4. ? 5 : i < 14 ? 3 : 7;
}

/** Return an updated filter. */
vtkSmartPointer<vtkLabelsToSurfaces> FilterOfBlocks(
  const ChoiceOf<vtkLabelsToSurfaces>& choose = {})
{
  return LabelSurfacesOf(LabelImageOf(28, 20, 20, TouchingBlocks), choose);
}

using Sides = std::array<int, 2>;

/** Return the labels on both sides of a triangle. */
Sides SidesOf(vtkPolyData* interfaces, vtkIdType cell)
{
  Sides sides;
  vtkIntArray::SafeDownCast(interfaces->GetCellData()->GetArray("BoundaryLabels"))
    ->GetTypedTuple(cell, sides.data());
  return sides;
}

std::set<Sides> AllSides(vtkPolyData* interfaces)
{
  std::set<Sides> all;
  for (vtkIdType cell = interfaces->GetNumberOfLines(); cell < interfaces->GetNumberOfCells();
       ++cell)
  {
    all.insert(SidesOf(interfaces, cell));
  }
  return all;
}

void ExpectClosedSurface(vtkPolyData* surface)
{
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_GT(EnclosedVolume(surface), 0.);
}

/** Expect that points are those of the interface mesh with the same global ids. */
void ExpectPointsOf(vtkPolyData* surface, vtkPolyData* interfaces)
{
  vtkDataArray* ids = surface->GetPointData()->GetGlobalIds();
  ASSERT_TRUE(ids);
  EXPECT_STREQ(ids->GetName(), "GlobalIds");
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p)
  {
    std::array<double, 3> own;
    std::array<double, 3> shared;
    surface->GetPoint(p, own.data());
    interfaces->GetPoint(static_cast<vtkIdType>(ids->GetComponent(p, 0)), shared.data());
    ASSERT_EQ(own, shared);
  }
}

}

TEST(LabelInterfaces, AreUnique)
{
  const auto filter = FilterOfBlocks();
  vtkPolyData* interfaces = filter->GetInterfaces();
  EXPECT_EQ(AllSides(interfaces), (std::set<Sides>{ { 3, 0 }, { 7, 0 }, { 3, 5 }, { 3, 7 } }));
  EXPECT_GT(interfaces->GetNumberOfLines(), 10); // where 3, 7 and the outside meet
  EXPECT_EQ(SidesOf(interfaces, 0), (Sides{ 0, 0 }));
  vtkDataArray* junction = interfaces->GetPointData()->GetArray("Junction");
  ASSERT_TRUE(junction);
  EXPECT_EQ(junction->GetRange()[1], 1.);
  EXPECT_EQ(interfaces->GetFieldData()->GetArray("Label")->GetNumberOfTuples(), 3);
  EXPECT_EQ(interfaces->GetFieldData()->GetArray("LabelColor")->GetNumberOfTuples(), 3);
  EXPECT_EQ(interfaces->GetFieldData()->GetAbstractArray("LabelName")->GetNumberOfTuples(), 3);
}

TEST(LabelInterfaces, FormTheBlocks)
{
  const auto filter = FilterOfBlocks();
  vtkPolyData* interfaces = filter->GetInterfaces();
  vtkIdType triangles = 0;
  for (unsigned int block = 0; block < 3; ++block)
  {
    SCOPED_TRACE(block);
    vtkPolyData* surface = BlockOf(filter, block);
    ExpectClosedSurface(surface);
    ExpectPointsOf(surface, interfaces);
    EXPECT_EQ(StopReason(surface), "converged");
    EXPECT_NEAR(FieldOf(surface, "Volume") / FieldOf(surface, "LabelVoxels"), 1., 4e-3);
    triangles += surface->GetNumberOfPolys();
  }
  vtkIdType twice = 0; // triangles between two labels, which are in two blocks
  for (vtkIdType cell = interfaces->GetNumberOfLines(); cell < interfaces->GetNumberOfCells();
       ++cell)
  {
    twice += SidesOf(interfaces, cell)[1] != 0 ? 1 : 0;
  }
  EXPECT_EQ(triangles, interfaces->GetNumberOfPolys() + twice);
}

TEST(LabelInterfaces, ContainOnlySelectedLabels)
{
  const auto filter = FilterOfBlocks(
    [](vtkLabelsToSurfaces* f)
    {
      f->AddLabel(5);
      f->AddLabel(7);
      f->SetBackgroundLabel(-1); // Label 0 is not background then.
    });
  vtkPolyData* interfaces = filter->GetInterfaces();
  EXPECT_EQ(AllSides(interfaces), (std::set<Sides>{ { 5, -1 }, { 7, -1 } }));
  EXPECT_EQ(interfaces->GetNumberOfPolys(),
    BlockOf(filter, 0)->GetNumberOfPolys() + BlockOf(filter, 1)->GetNumberOfPolys());
  EXPECT_EQ(interfaces->GetNumberOfPoints(),
    BlockOf(filter, 0)->GetNumberOfPoints() + BlockOf(filter, 1)->GetNumberOfPoints());
  EXPECT_GT(interfaces->GetNumberOfLines(), 10) << "where 7, 3 and 0 meet";
  EXPECT_TRUE(interfaces->GetFieldData()->GetArray("WorstAngle"));
  for (unsigned int block = 0; block < 2; ++block)
  {
    vtkPolyData* surface = BlockOf(filter, block);
    ExpectPointsOf(surface, interfaces);
    // Normals point away from the selected label.
    vtkNew<vtkPolyData> part;
    part->SetPoints(interfaces->GetPoints());
    vtkNew<vtkCellArray> triangles;
    for (vtkIdType cell = interfaces->GetNumberOfLines(); cell < interfaces->GetNumberOfCells();
         ++cell)
    {
      if (SidesOf(interfaces, cell)[0] == (block == 0 ? 5 : 7))
      {
        triangles->InsertNextCell(interfaces->GetCell(cell));
      }
    }
    part->SetPolys(triangles);
    EXPECT_NEAR(EnclosedVolume(part), EnclosedVolume(surface), 1e-6 * EnclosedVolume(surface));
  }
}

TEST(LabelInterfaces, OfMergedLabelsHaveJunctionLines)
{
  const auto filter = FilterOfBlocks(
    [](vtkLabelsToSurfaces* f)
    {
      f->AddLabel(3);
      f->AddLabel(5);
      f->MergeOn();
    });
  vtkPolyData* interfaces = filter->GetInterfaces();
  EXPECT_EQ(AllSides(interfaces), (std::set<Sides>{ { 3, 0 } })) << "5 is inside";
  ASSERT_GT(interfaces->GetNumberOfLines(), 10) << "where 3, 7 and 0 meet";
  EXPECT_EQ(SidesOf(interfaces, 0), (Sides{ 0, 0 }));
  EXPECT_EQ(interfaces->GetNumberOfPolys(), BlockOf(filter, 0)->GetNumberOfPolys());
}

TEST(LabelInterfaces, AreCoarserWithTolerance)
{
  const auto filter = FilterOfBlocks();
  const auto fine = static_cast<double>(filter->GetInterfaces()->GetNumberOfPoints());
  EXPECT_FALSE(filter->GetInterfaces()->GetPointData()->GetArray("EdgeSize"));
  EXPECT_FALSE(BlockOf(filter, 0)->GetFieldData()->GetArray("WithinTolerance"));
  filter->SetTolerance(0.3);
  filter->Update();
  vtkPolyData* interfaces = filter->GetInterfaces();
  EXPECT_LT(static_cast<double>(interfaces->GetNumberOfPoints()), 0.7 * fine);
  vtkDataArray* sizes = interfaces->GetPointData()->GetArray("EdgeSize");
  ASSERT_TRUE(sizes);
  EXPECT_GT(sizes->GetRange()[1], 1.5 * sizes->GetRange()[0]);
  for (unsigned int block = 0; block < 3; ++block)
  {
    SCOPED_TRACE(block);
    vtkPolyData* surface = BlockOf(filter, block);
    ExpectClosedSurface(surface);
    EXPECT_NEAR(FieldOf(surface, "Volume") / FieldOf(surface, "LabelVoxels"), 1., 6e-3);
    EXPECT_GT(FieldOf(surface, "WithinTolerance"), 0.9);
    EXPECT_GT(FieldOf(surface, "LargestDistance"), 0.);
    vtkDataArray* own = surface->GetPointData()->GetArray("EdgeSize");
    vtkDataArray* ids = surface->GetPointData()->GetGlobalIds();
    ASSERT_TRUE(own && ids);
    for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p)
    {
      const auto shared = static_cast<vtkIdType>(ids->GetComponent(p, 0));
      ASSERT_NEAR(own->GetComponent(p, 0), sizes->GetComponent(shared, 0), 1e-5);
    }
  }
}

TEST(LabelInterfaces, RespectMaximumEdgeLength)
{
  const auto image = LabelImageOf(28, 20, 20, TouchingBlocks);
  image->SetSpacing(0.5, 0.5, 0.5);
  const auto filter = LabelSurfacesOf(image,
    [](vtkLabelsToSurfaces* f)
    {
      f->SetTolerance(0.2);
      f->SetVoxelTolerance(0.0); // The corners of blocks then need short edges.
      f->SetMaximumEdgeLength(1.5);
    });
  vtkPolyData* interfaces = filter->GetInterfaces();
  vtkDataArray* sizes = interfaces->GetPointData()->GetArray("EdgeSize");
  EXPECT_NEAR(sizes->GetRange()[0], 0.5 * 0.8 * std::cbrt(0.2387), 1e-3) << "single voxel";
  EXPECT_NEAR(sizes->GetRange()[1], 1.5 / 2.2, 1e-3); // InterfaceOptions::LongestInEdge is 2.2.
  double longest = 0.;
  for (vtkIdType cell = interfaces->GetNumberOfLines(); cell < interfaces->GetNumberOfCells();
       ++cell)
  {
    for (int k = 0; k < 3; ++k)
    {
      vtkCell* edge = interfaces->GetCell(cell)->GetEdge(k);
      longest = std::max(longest, std::sqrt(edge->GetLength2()));
    }
  }
  EXPECT_LT(longest, 1.5);
}

TEST(LabelInterfaces, AreFlatAtImageBorder)
{
  const auto filter =
    LabelSurfacesOf(LabelImageOf(12, 10, 9, [](int i, int, int) { return i < 5 ? 3. : 7.; }));
  EXPECT_FALSE(filter->GetInterfaces()->GetCellData()->GetArray("BoxFace"));
  EXPECT_LT(filter->GetInterfaces()->GetBounds()[0], -0.6);
  filter->SetBoxFacesToFlat();
  filter->Update();
  vtkPolyData* interfaces = filter->GetInterfaces();
  const std::array<double, 6> planes = { -0.5, 11.5, -0.5, 9.5, -0.5, 8.5 };
  for (std::size_t side = 0; side < planes.size(); ++side)
  {
    EXPECT_NEAR(interfaces->GetBounds()[side], planes[side], 1e-12);
  }
  EXPECT_EQ(AllSides(interfaces), (std::set<Sides>{ { 3, 0 }, { 7, 0 }, { 3, 7 } }));
  for (unsigned int block = 0; block < 2; ++block)
  {
    vtkPolyData* surface = BlockOf(filter, block);
    ExpectClosedSurface(surface);
    EXPECT_NEAR(FieldOf(surface, "Volume") / FieldOf(surface, "LabelVoxels"), 1., 1e-3);
    EXPECT_EQ(surface->GetCellData()->GetArray("BoxFace")->GetRange()[1], 6.);
    EXPECT_NEAR(surface->GetPointData()->GetArray("Residual")->GetRange()[1], 0., 0.5);
  }
  filter->SetBoxFacesToPeriodic();
  filter->Update();
  std::array<int, 7> triangles = {};
  vtkDataArray* faces = filter->GetInterfaces()->GetCellData()->GetArray("BoxFace");
  for (vtkIdType cell = 0; cell < faces->GetNumberOfTuples(); ++cell)
  {
    ++triangles[static_cast<std::size_t>(faces->GetComponent(cell, 0))];
  }
  EXPECT_EQ(triangles[1], triangles[2]);
  EXPECT_EQ(triangles[3], triangles[4]);
  EXPECT_EQ(triangles[5], triangles[6]);
  filter->SetInputData(
    LabelImageOf(12, 10, 9, [](int i, int j, int) { return i + j < 10 ? 3. : 7.; }));
  EXPECT_TRUE(Has(MessagesOfUpdate(filter), "not periodic along x"));
  filter->SetBoxFaces(3);
  EXPECT_TRUE(Has(MessagesOfUpdate(filter), "Box Faces is 3"));
}

class CancelledLabelInterfaces : public testing::TestWithParam<double>
{
};

TEST_P(CancelledLabelInterfaces, AreMarkedAndRecomputed)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(LabelImageOf(28, 20, 20, TouchingBlocks));
  ProgressListener listener(filter);
  listener.StopAt = GetParam();
  filter->Update();
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 3u);
  for (unsigned int block = 0; block < 3; ++block)
  {
    EXPECT_EQ(StopReason(BlockOf(filter, block)), "cancelled");
    if (BlockOf(filter, block)->GetNumberOfCells() > 0)
    {
      ExpectClosedSurface(BlockOf(filter, block));
    }
  }
  listener.StopAt = 2.0;
  filter->Modified();
  filter->Update();
  ExpectSameSurfaces(filter->GetInterfaces(), FilterOfBlocks()->GetInterfaces());
}

INSTANTIATE_TEST_SUITE_P(At, CancelledLabelInterfaces, testing::Values(0.01, 0.5));
