// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelImages.h"
#include "SameOutputs.h"

#include <vtkCell.h>

using namespace volumic;

namespace
{
using Names = std::vector<std::string>;
}

TEST(LabelsToSurfaces, HasAClosedSurfaceOfEachLabel)
{
  const auto filter = LabelSurfacesOf(BallsImage());
  EXPECT_EQ(BlockNames(filter->GetOutput()), (Names{ "Label 3", "Label 7" }));
  for (const unsigned int block : { 0u, 1u })
  {
    vtkPolyData* surface = BlockOf(filter, block);
    ASSERT_GT(surface->GetNumberOfPoints(), 100);
    EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
    EXPECT_EQ(FieldOf(surface, "Genus"), 0.);
    EXPECT_EQ(FieldOf(surface, "NumberOfComponents"), 1.);
    EXPECT_EQ(FieldOf(surface, "Label"), block == 0 ? 3. : 7.);
    EXPECT_LE(FieldOf(surface, "MissedVoxels"), 3.);
    EXPECT_EQ(StopReason(surface), "converged");
    EXPECT_NEAR(EnclosedVolume(surface), FieldOf(surface, "LabelVoxels"),
      0.01 * FieldOf(surface, "LabelVoxels"));
    auto* labels = vtkIntArray::SafeDownCast(surface->GetCellData()->GetArray("Label"));
    ASSERT_TRUE(labels);
    EXPECT_EQ(labels->GetRange()[0], block == 0 ? 3. : 7.);
    EXPECT_EQ(labels->GetRange()[1], block == 0 ? 3. : 7.);
  }
}

TEST(LabelsToSurfaces, AcceptsIntegersOfAnyTypeAsPointsOrCells)
{
  const auto requested = LabelSurfacesOf(BallsImage());
  for (const int type :
    { VTK_UNSIGNED_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT,
      VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_CHAR, VTK_FLOAT, VTK_DOUBLE })
  {
    SCOPED_TRACE(type);
    vtkNew<vtkLabelsToSurfaces> filter;
    filter->SetInputData(BallsImage(type));
    const bool isReal = type == VTK_FLOAT || type == VTK_DOUBLE;
    const std::string warnings = MessagesOfUpdate(filter, vtkCommand::WarningEvent);
    EXPECT_EQ(CountOf(warnings, "array 'Labels' is of type"), isReal ? 1 : 0) << warnings;
    ExpectSameBlocks(filter->GetOutput(), requested->GetOutput());
  }
  const auto ofCells = LabelSurfacesOf(AsCells(BallsImage()));
  ExpectSameBlocks(ofCells->GetOutput(), requested->GetOutput());
}

TEST(LabelsToSurfaces, RenumbersLabelsOutsideTheRangeOfInt)
{
  const auto balls = LabelSurfacesOf(BallsImage());
  ASSERT_EQ(BlockNames(balls->GetOutput()), (Names{ "Label 3", "Label 7" }));
  for (const int type : { VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG, VTK_DOUBLE })
  {
    SCOPED_TRACE(type);
    const auto image = BallsImage(type);
    vtkDataArray* voxels = Voxels(image);
    for (vtkIdType v = 0; v < voxels->GetNumberOfTuples(); ++v)
    {
      voxels->SetTuple1(v, voxels->GetTuple1(v) == 3.0 ? 4294967295.0 : voxels->GetTuple1(v));
    }
    vtkNew<vtkLabelsToSurfaces> filter;
    filter->SetInputData(image);
    const std::string warnings = MessagesOfUpdate(filter, vtkCommand::WarningEvent);
    EXPECT_TRUE(Has(warnings, "'Labels' has 1 label outside the range of int"));
    EXPECT_TRUE(Has(warnings, "4294967295 is 8."));
    ASSERT_EQ(BlockNames(filter->GetOutput()), (Names{ "Label 7", "4294967295" }));
    EXPECT_EQ(FieldOf(BlockOf(filter, 1), "Label"), 8.0);
    EXPECT_EQ(
      FieldOf(BlockOf(filter, 1), "LabelVoxels"), FieldOf(BlockOf(balls, 0), "LabelVoxels"));
  }
}

TEST(LabelsToSurfaces, IsBitIdenticalForAnyNumberOfThreadsAndRuns)
{
  // Many labels with junction lines, and large labels.
  const auto cells = [](int i, int j, int k)
  {
    const int x = (i + 4) % 32; // opposite sides have the same labels
    const int y = (j + 5) % 20;
    return x < 16 ? 1 + x / 8 + 2 * (y / 10) + 4 * ((k + 5) % 20 / 10) : y < 10 ? 20 : 0;
  };
  const auto image = LabelImageOf(32, 20, 20, cells);
  for (int faces = 0; faces < 3; ++faces) // rounded, flat, periodic
  {
    SCOPED_TRACE(faces);
    const auto madeOn = [&](int threads)
    {
      return LabelSurfacesOf(image,
        [&](vtkLabelsToSurfaces* f)
        {
          f->SetNumberOfThreads(threads);
          f->SetBoxFaces(faces);
          f->SetTolerance(faces == 1 ? 0.3 : 0.);
        });
    };
    const auto one = madeOn(1);
    EXPECT_EQ(one->GetOutput()->GetNumberOfBlocks(), 9u);
    for (const int threads : { 2, 3 })
    {
      const auto more = madeOn(threads);
      ExpectSameBlocks(more->GetOutput(), one->GetOutput());
      ExpectSameSurfaces(more->GetInterfaces(), one->GetInterfaces());
    }
  }
}

TEST(LabelsToSurfaces, MeshesSelectedLabels)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  filter->AddLabel(7);
  filter->AddLabel(7);
  filter->Update();
  EXPECT_EQ(BlockNames(filter->GetOutput()), (Names{ "Label 7" }));
  EXPECT_EQ(filter->GetNumberOfLabels(), 2);
  EXPECT_EQ(filter->GetLabel(1), 7);
  EXPECT_EQ(filter->GetLabel(2), 0) << "BackgroundLabel";
  filter->ClearLabels();
  filter->AddLabel(0);
  filter->Update();
  ASSERT_EQ(BlockNames(filter->GetOutput()), (Names{ "Label 0" })) << "the background, on request";
  EXPECT_EQ(FieldOf(BlockOf(filter, 0), "NumberOfComponents"), 2.) << "a block with a cavity";
  filter->ClearLabels();
  filter->SetBackgroundLabel(3);
  filter->Update();
  EXPECT_EQ(BlockNames(filter->GetOutput()), (Names{ "Label 0", "Label 7" }));
}

TEST(LabelsToSurfaces, SurfacesAreIndependentOfTheSelection)
{
  const auto sectors = [](int i, int j, int k) {
    return k < 8 ? 9 : std::atan2(j - 15.3, i - 15.6) < -1. ? 1 : i < 16 ? 2 : k < 20 ? 3 : 0;
  };
  const auto image = LabelImageOf(32, 32, 24, sectors);
  const std::array<int, 4> labels = { 1, 2, 3, 9 };
  for (const int faces : { 0, 1 }) // rounded, flat
  {
    SCOPED_TRACE(faces);
    const auto surfacesOf = [&](const std::vector<unsigned int>& blocks)
    {
      return LabelSurfacesOf(image,
        [&](vtkLabelsToSurfaces* f)
        {
          f->SetBoxFaces(faces);
          for (const unsigned int block : blocks)
          {
            f->AddLabel(labels[block]);
          }
        });
    };
    const auto all = surfacesOf({});
    for (const std::vector<unsigned int>& blocks :
      { std::vector<unsigned int>{ 2 }, std::vector<unsigned int>{ 1, 3 } })
    {
      const auto some = surfacesOf(blocks);
      for (unsigned int b = 0; b < blocks.size(); ++b)
      {
        vtkPointData* one = BlockOf(some, b)->GetPointData();
        vtkPointData* same = BlockOf(all, blocks[b])->GetPointData();
        EXPECT_NE(one->GetGlobalIds()->GetRange()[1], same->GetGlobalIds()->GetRange()[1])
          << "points of port 1 are others";
        one->SetGlobalIds(same->GetGlobalIds());
        ExpectSameSurfaces(BlockOf(some, b), BlockOf(all, blocks[b]));
      }
    }
  }
}

TEST(LabelsToSurfaces, MergesLabelsToOneSurfaceWithTheLabelsOfTheNearestVoxels)
{
  const auto image = LabelImageOf(21, 13, 13,
    [](int i, int j, int k) {
      return std::hypot(i - 10., j - 6., k - 6.) > 5. ? 0 : i > 10 ? 7 : 3;
    });
  image->SetSpacing(3., 0.5, 1.);
  const auto filter = LabelSurfacesOf(image, [](vtkLabelsToSurfaces* f) { f->MergeOn(); });
  ASSERT_EQ(BlockNames(filter->GetOutput()), (Names{ "Labels 3, 7" }));
  vtkPolyData* surface = BlockOf(filter, 0);
  EXPECT_EQ(FieldOf(surface, "NumberOfComponents"), 1.);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_EQ(surface->GetFieldData()->GetArray("Label")->GetNumberOfTuples(), 2);
  vtkDataArray* labels = surface->GetCellData()->GetArray("Label");
  int counts[2] = { 0, 0 };
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    const double* bounds = surface->GetCell(c)->GetBounds();
    const bool isOfSeven = bounds[0] > 3. * 10.5;
    if (isOfSeven || bounds[1] < 3. * 10.5)
    {
      ++counts[isOfSeven];
      EXPECT_EQ(labels->GetComponent(c, 0), isOfSeven ? 7. : 3.) << "cell " << c;
    }
  }
  EXPECT_GT(std::min(counts[0], counts[1]), 100);
}

TEST(LabelsToSurfaces, HasNamesAndColorsOfImageAndFilter)
{
  const auto image = BallsImage();
  AddNames(image);
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(image);
  filter->SetLabelName(3, "Leber");
  filter->SetLabelColor(3, 0.1, 0.2, 0.3);
  filter->Update();
  EXPECT_EQ(BlockNames(filter->GetOutput()), (Names{ "Leber", "kidney" }));
  EXPECT_STREQ(filter->GetLabelName(3), "Leber");
  EXPECT_STREQ(filter->GetLabelName(4), "");
  EXPECT_EQ(FieldOf(BlockOf(filter, 0), "LabelColor", 2), 0.3);
  EXPECT_NEAR(FieldOf(BlockOf(filter, 1), "LabelColor", 2), 0.2, 1e-9) << "51 of 255";
  auto* name =
    vtkStringArray::SafeDownCast(BlockOf(filter, 1)->GetFieldData()->GetAbstractArray("LabelName"));
  ASSERT_TRUE(name);
  EXPECT_EQ(name->GetValue(0), "kidney");
  filter->ClearLabelNames();
  filter->ClearLabelColors();
  filter->Update();
  EXPECT_EQ(BlockNames(filter->GetOutput()), (Names{ "liver", "kidney" }));
  EXPECT_NEAR(FieldOf(BlockOf(filter, 0), "LabelColor", 1), 0.4, 1e-9);
}

TEST(LabelsToSurfaces, AppliesOriginSpacingDirectionAndExtent)
{
  const auto plain = LabelSurfacesOf(BallsImage());
  const auto image = BallsImage();
  image->SetExtent(5, 38, -7, 20, 100, 127);
  image->SetOrigin(10., 20., 30.);
  image->SetSpacing(2., 2., 2.);
  // One direction matrix is a reflection.
  const double direction[9] = { 0., 1., 0., 1., 0., 0., 0., 0., 1. };
  image->SetDirectionMatrix(direction);
  const auto moved = LabelSurfacesOf(image);
  for (const unsigned int block : { 0u, 1u })
  {
    EXPECT_NEAR(EnclosedVolume(BlockOf(moved, block)), 8. * EnclosedVolume(BlockOf(plain, block)),
      0.01 * EnclosedVolume(BlockOf(moved, block)))
      << "outward in a mirror, too";
    EXPECT_LE(FieldOf(BlockOf(moved, block), "MissedVoxels"), 3.);
    double index[3], centre[3];
    BlockOf(moved, block)->GetCenter(centre);
    image->TransformPhysicalPointToContinuousIndex(centre, index);
    EXPECT_NEAR(index[0], (block == 0 ? 11. : 25.) + 5., 0.3);
    EXPECT_NEAR(index[1], 14. - 7., 0.3);
    EXPECT_NEAR(index[2], 14. + 100., 0.3);
  }
}

TEST(LabelsToSurfaces, HasTheRequestedEdgeLength)
{
  const auto image = BallsImage();
  const auto filter = LabelSurfacesOf(image);
  const vtkIdType atLevel0 = BlockOf(filter, 0)->GetNumberOfCells();
  filter->SetFinestLevel(-1);
  filter->Update();
  EXPECT_EQ(FieldOf(BlockOf(filter, 0), "Level"), -1.);
  EXPECT_GT(BlockOf(filter, 0)->GetNumberOfCells(), 2.2 * atLevel0);
  filter->SetFinestLevel(1);
  filter->Update();
  EXPECT_EQ(FieldOf(BlockOf(filter, 0), "Level"), 1.);
  EXPECT_LT(BlockOf(filter, 0)->GetNumberOfCells(), 0.6 * atLevel0);
  EXPECT_EQ(OpenOrNonManifoldEdges(BlockOf(filter, 0)), 0);
  filter->SetFinestLevel(0);
  filter->SetEdgeLength(2.5);
  filter->Update();
  EXPECT_NEAR(MeanEdgeOf(BlockOf(filter, 0)), 2.5, 0.3);
}

TEST(LabelsToSurfaces, ReportsProgressAndCanBeCancelled)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  ProgressListener listener(filter);
  filter->Update();
  EXPECT_TRUE(std::is_sorted(listener.Shares.begin(), listener.Shares.end()));
  EXPECT_EQ(listener.Shares.back(), 1.);
  EXPECT_EQ(listener.Texts,
    (std::set<std::string>{
      "Reading the labels", "Fields of the labels", "Interfaces of the labels" }));
  listener.StopAt = 0.;
  filter->Modified();
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_EQ(warnings.Get(), "") << "unfinished labels are not lost";
  EXPECT_EQ(filter->GetErrorCode(), 0u);
}

TEST(LabelsToSurfaces, EndsAtItsTimeLimit)
{
  vtkNew<vtkLabelsToSurfaces> filter;
  filter->SetInputData(BallsImage());
  const auto whole = LabelSurfacesOf(filter->GetInputDataObject(0, 0));
  filter->SetTimeLimit(1e-9);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfBlocks(), 2u);
  for (const unsigned int block : { 0u, 1u })
  {
    EXPECT_EQ(StopReason(BlockOf(filter, block)), "time limit");
  }
  filter->SetTimeLimit(0.0);
  filter->Update();
  ExpectSameBlocks(filter->GetOutput(), whole->GetOutput());
}
