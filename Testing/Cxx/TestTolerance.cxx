// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SameOutputs.h"

using namespace volumic;

namespace
{
/** A large ball: flat enough for longer edges. */
vtkSmartPointer<vtkImageData> Image()
{
  static const vtkSmartPointer<vtkImageData> image = BallImage(56, 56, 56, 0.42);
  return image;
}

/** Return a filter with these settings after Update(). */
vtkSmartPointer<vtkDeformableSurface> Graded(
  double tolerance, const Choice& choose = [](vtkDeformableSurface*) {})
{
  const auto filter = FilterOf(Image());
  filter->SetTolerance(tolerance);
  choose(filter);
  filter->Update();
  return filter;
}

bool IsGraded(vtkPolyData* surface)
{
  return surface && surface->GetPointData()->HasArray("EdgeSize") != 0;
}
}

TEST(Tolerance, HasEdgeSizesAndDistances)
{
  const auto even = Graded(0.0);
  EXPECT_FALSE(IsGraded(even->GetOutput()));
  EXPECT_TRUE(std::isnan(FieldOf(even->GetOutput(), "WithinTolerance")));
  const auto filter = Graded(0.2);
  vtkPolyData* surface = filter->GetOutput();
  EXPECT_LT(1.5 * surface->GetNumberOfPoints(), even->GetOutput()->GetNumberOfPoints());
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  ASSERT_TRUE(IsGraded(surface));
  double range[2];
  surface->GetPointData()->GetArray("EdgeSize")->GetRange(range);
  const double without = 1.6 * FieldOf(surface, "Delta");
  EXPECT_GE(range[0], 0.999 * without);
  EXPECT_GT(range[1], 1.5 * without);
  EXPECT_LE(range[1], 4.001 * without);
  EXPECT_GT(FieldOf(surface, "WithinTolerance"), 0.98);
  EXPECT_LT(FieldOf(surface, "LargestDistance"), 0.5);
  EXPECT_EQ(StopReason(surface), "converged");
  // It applies to the finest level only.
  EXPECT_FALSE(IsGraded(SurfaceAt(filter, 1)));
  EXPECT_TRUE(AreSameSurfaces(SurfaceAt(filter, 1), SurfaceAt(even, 1)));
}

TEST(Tolerance, IsIdenticalToANewRunAfterAnyRun)
{
  const auto filter = FilterOf(Image(), [](vtkDeformableSurface* f) { f->SetTolerance(0.3); });
  for (const int finest : { 1, 0, -1, 0, 1 })
  {
    SCOPED_TRACE(finest);
    filter->SetFinestLevel(finest);
    filter->Update();
    const auto other =
      Graded(0.3, [finest](vtkDeformableSurface* f) { f->SetFinestLevel(finest); });
    EXPECT_TRUE(IsGraded(filter->GetOutput()));
    ExpectSameSurfaces(filter->GetOutput(), other->GetOutput());
  }
}

TEST(Tolerance, IsInWorldUnits)
{
  // The same image in micrometers.
  vtkNew<vtkImageData> small;
  small->ShallowCopy(Image());
  small->SetSpacing(1e-3, 1e-3, 1e-3);
  small->SetOrigin(5., -7., 2.);
  const auto large = Graded(0.2, [](vtkDeformableSurface* f) { f->SetMaximumEdgeLength(4.); });
  const auto filter = Graded(0.2e-3,
    [&small](vtkDeformableSurface* f)
    {
      f->SetInputData(small);
      f->SetMaximumEdgeLength(4e-3);
    });
  // Rounding of lengths may change whether an edge is split.
  EXPECT_NEAR(static_cast<double>(filter->GetOutput()->GetNumberOfPoints()),
    static_cast<double>(large->GetOutput()->GetNumberOfPoints()),
    0.02 * large->GetOutput()->GetNumberOfPoints());
  EXPECT_NEAR(FieldOf(filter->GetOutput(), "LargestDistance"),
    1e-3 * FieldOf(large->GetOutput(), "LargestDistance"), 2e-4);
  double of[2], ofLarge[2];
  filter->GetOutput()->GetPointData()->GetArray("EdgeSize")->GetRange(of);
  large->GetOutput()->GetPointData()->GetArray("EdgeSize")->GetRange(ofLarge);
  EXPECT_NEAR(of[1], 1e-3 * ofLarge[1], 1e-4);
  EXPECT_LE(of[1], 1.6 / 2.5 * 4e-3 * 1.0001) << "edges of up to 4 micrometres";
}

TEST(Tolerance, IsBitIdenticalForAnyNumberOfThreads)
{
  const auto one = Graded(0.2, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(1); });
  const auto three = Graded(0.2, [](vtkDeformableSurface* f) { f->SetNumberOfThreads(3); });
  ExpectSameSurfaces(one->GetOutput(), three->GetOutput());
}

TEST(Tolerance, KeepsThinPartsBesideAnUngradedSurface)
{
  // A sheet of one voxel, two voxels beside a ball, that no coarser level resolves.
  const auto image = BallImage(40, 40, 40, 0.3);
  FillBox(image, { 3, 19, 4 }, { 6, 20, 36 });
  const auto input = [&image](vtkDeformableSurface* f) { f->SetInputData(image); };
  const auto even = Graded(0.0, input);
  ASSERT_EQ(FieldOf(even->GetOutput(), "NumberOfComponents"), 2.);
  for (const double tolerance : { 0.1, 0.2, 0.5, 2. })
  {
    SCOPED_TRACE(tolerance);
    const auto graded = Graded(tolerance, input);
    for (const char* name : { "MissingParts", "MissingBoundary", "NumberOfComponents" })
    {
      EXPECT_EQ(FieldOf(graded->GetOutput(), name), FieldOf(even->GetOutput(), name)) << name;
    }
    // It is as long as it is.
    const double* bounds = graded->GetOutput()->GetBounds();
    const double* ofEven = even->GetOutput()->GetBounds();
    EXPECT_NEAR(bounds[0], ofEven[0], 0.5);
    EXPECT_NEAR(bounds[4], ofEven[4], 1.);
    EXPECT_NEAR(bounds[5], ofEven[5], 1.);
  }
}

TEST(Tolerance, AppliesToKeptComponents)
{
  const auto filter =
    Graded(0.2, [](vtkDeformableSurface* f) { f->SetKeepComponentsToLargestComponent(); });
  const auto all = Graded(0.2);
  ASSERT_TRUE(IsGraded(filter->GetOutput()));
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("EdgeSize")->GetNumberOfTuples(),
    filter->GetOutput()->GetNumberOfPoints());
  EXPECT_EQ(
    FieldOf(filter->GetOutput(), "WithinTolerance"), FieldOf(all->GetOutput(), "WithinTolerance"));
}

TEST(Tolerance, ReportsInvalidProperties)
{
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<ErrorCase<vtkDeformableSurface>> cases = {
    { [](vtkDeformableSurface* f) { f->SetTolerance(-0.5); }, { "Tolerance is -0.5", "0 (edges" } },
    { [=](vtkDeformableSurface* f) { f->SetTolerance(infinite); }, { "Tolerance is inf" } },
    { [](vtkDeformableSurface* f) { f->SetTolerance(std::nan("")); }, { "Tolerance is nan" } },
    { [](vtkDeformableSurface* f) { f->SetMaximumEdgeLength(-1.); },
      { "Maximum Edge Length is -1", "0 (automatic)" } },
    { [=](vtkDeformableSurface* f) { f->SetMaximumEdgeLength(infinite); },
      { "Maximum Edge Length is inf" } },
    { [](vtkDeformableSurface* f) { f->SetGradation(0.); }, { "Gradation is 0", "more than 0" } },
    { [](vtkDeformableSurface* f) { f->SetGradation(0.31); },
      { "Gradation is 0.31", "at most 0.3" } },
    { [](vtkDeformableSurface* f) { f->SetEdgeLength(1.5); },
      { "Tolerance is 0.2 and Edge Length is 1.5", "Set Edge Length to 0" } },
    { [](vtkDeformableSurface* f) { f->SnapToIsoValueOff(); },
      { "Tolerance is 0.2, but Snap To Iso Value is off" } },
    { [](vtkDeformableSurface* f) { f->SetIsopotentialWeight(0.); },
      { "Tolerance is 0.2, but Isopotential Weight is not more than" } },
    { [](vtkDeformableSurface* f) { f->SetTolerance(0.), f->ThinPartsOn(), f->SetEdgeLength(1.5); },
      { "Thin Parts is on and Edge Length is 1.5", "Set Edge Length to 0" } },
    { [](vtkDeformableSurface* f) { f->ThinPartsOn(), f->SetEdgeLength(1.5); },
      { "Tolerance is 0.2 and Edge Length is 1.5",
        "set Tolerance to 0 and switch Thin Parts off" } },
    { [](vtkDeformableSurface* f)
      { f->SetTolerance(0.), f->ThinPartsOn(), f->SnapToIsoValueOff(); },
      { "Thin Parts is on, but Snap To Iso Value is off", "Switch Thin Parts off" } },
    { [](vtkDeformableSurface* f)
      { f->SetTolerance(0.), f->ThinPartsOn(), f->SetIsopotentialWeight(0.); },
      { "Thin Parts is on, but Isopotential Weight is not more than" } },
  };
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.Parts.front());
    const auto filter = FilterOf(Image(), [](vtkDeformableSurface* f) { f->SetTolerance(0.2); });
    test.Spoil(filter);
    ExpectErrorOf(filter, test.Parts);
  }
}
