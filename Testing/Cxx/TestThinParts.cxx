// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
/** A thick ball with a protruding sheet of one voxel. */
vtkSmartPointer<vtkImageData> Image()
{
  static const vtkSmartPointer<vtkImageData> image = []
  {
    auto made = BallImage(60, 48, 48, 0.3);
    FillBox(made, { 48, 24, 10 }, { 58, 25, 38 });
    return made;
  }();
  return image;
}

/** Return a filter with these settings after Update(). */
vtkSmartPointer<vtkVolumeToSurface> Made(
  bool thinParts, const ChoiceOf<vtkVolumeToSurface>& choose = [](vtkVolumeToSurface*) {})
{
  const auto filter = FilterOf<vtkVolumeToSurface>(Image(), choose);
  filter->SetThinParts(thinParts);
  filter->Update();
  return filter;
}

bool HasThickness(vtkPolyData* surface)
{
  return surface->GetPointData()->HasArray("Thickness") != 0;
}

vtkIdType PointsOf(vtkDeformableSurface* filter)
{
  return filter->GetOutput()->GetNumberOfPoints();
}
}

TEST(ThinParts, HaveShorterEdges)
{
  const auto even = Made(false);
  const auto thin = Made(true);
  const auto fine = Made(false, [](vtkVolumeToSurface* f) { f->SetFinestLevel(-1); });
  vtkPolyData* surface = thin->GetOutput();
  EXPECT_EQ(FieldOf(surface, "Level"), -1);
  EXPECT_EQ(FieldOf(surface, "Delta"), FieldOf(fine->GetOutput(), "Delta"));
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_LT(1.5 * PointsOf(thin), PointsOf(fine)) << "the ball keeps its triangles";
  EXPECT_GT(PointsOf(thin), PointsOf(even));
  EXPECT_EQ(FieldOf(surface, "MissingBoundary"), 0.);
  EXPECT_EQ(
    FieldOf(surface, "NumberOfComponents"), FieldOf(fine->GetOutput(), "NumberOfComponents"));
  // A sheet of a voxel on either side of which the next voxel is air is a voxel thick.
  double range[2];
  ASSERT_TRUE(HasThickness(surface));
  surface->GetPointData()->GetArray("Thickness")->GetRange(range);
  EXPECT_GT(range[0], 0.2);
  EXPECT_LT(range[0], 1.2);
  EXPECT_NEAR(range[1], 8. * FieldOf(surface, "Delta"), 1e-5);
  surface->GetPointData()->GetArray("EdgeSize")->GetRange(range);
  EXPECT_NEAR(range[0], 1.6 * FieldOf(surface, "Delta"), 1e-5);
  EXPECT_NEAR(range[1], 1.6 * FieldOf(even->GetOutput(), "Delta"), 1e-5);
  EXPECT_TRUE(std::isnan(FieldOf(surface, "WithinTolerance"))) << "no tolerance was given";
  // Level 0 is the same as without thin parts.
  EXPECT_TRUE(AreSameSurfaces(SurfaceAt(thin, 0), SurfaceAt(even, 0)));
  EXPECT_FALSE(HasThickness(SurfaceAt(thin, 0)));
  EXPECT_EQ(thin->GetLevels()->GetNumberOfBlocks(), even->GetLevels()->GetNumberOfBlocks() + 1);
  EXPECT_EQ(thin->GetFinestLevel(), 0) << "what was set stays what it is";
}

TEST(ThinParts, AreIdenticalToANewRunInAnyOrder)
{
  const auto filter = FilterOf<vtkVolumeToSurface>(Image());
  for (const auto& [thinParts, finest, preview] : std::vector<std::array<int, 3>>{ { 0, 0, 0 },
         { 1, 0, 0 }, { 1, 1, 0 }, { 1, 0, 1 }, { 1, 0, 0 }, { 0, -1, 0 }, { 1, -1, 0 } })
  {
    SCOPED_TRACE(::testing::Message() << thinParts << " " << finest << " " << preview);
    const auto choose = [level = finest, isPreview = preview != 0](vtkVolumeToSurface* f)
    {
      f->SetFinestLevel(level);
      f->SetPreview(isPreview);
    };
    filter->SetThinParts(thinParts != 0);
    choose(filter);
    filter->Update();
    ExpectSameSurfaces(filter->GetOutput(), Made(thinParts != 0, choose)->GetOutput());
  }
}

TEST(ThinParts, WorkWithATolerance)
{
  // Edges are longer in flat regions, and shorter in thin parts.
  const auto both = Made(true, [](vtkVolumeToSurface* f) { f->SetTolerance(0.4); });
  vtkPolyData* surface = both->GetOutput();
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_TRUE(HasThickness(surface));
  EXPECT_GT(FieldOf(surface, "WithinTolerance"), 0.95);
  EXPECT_EQ(FieldOf(surface, "MissingBoundary"), 0.);
  EXPECT_LT(PointsOf(both), PointsOf(Made(true)));
}

TEST(ThinParts, AreBitIdenticalForAnyNumberOfThreads)
{
  const auto one = Made(true, [](vtkVolumeToSurface* f) { f->SetNumberOfThreads(1); });
  const auto three = Made(true, [](vtkVolumeToSurface* f) { f->SetNumberOfThreads(3); });
  ExpectSameSurfaces(one->GetOutput(), three->GetOutput());
}
