// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Every property of the filter reaches the surface: what it does there, the tests of the core tell.
#include "SurfaceTestTools.h"

#include <vtkTable.h>
#include <vtkVariant.h>

#include <sstream>

using namespace volumic;

namespace
{
vtkSmartPointer<vtkDeformableSurface> SurfaceWith(
  const std::function<void(vtkDeformableSurface&)>& change)
{
  auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
  filter->SetInputDataObject(BallImage(30, 30, 30));
  filter->SetIsoValue(50.0);
  filter->SetCoarsestLevel(0);
  change(*filter);
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfPoints(), 100);
  return filter;
}

double History(vtkDeformableSurface* filter, vtkIdType row, const char* column)
{
  vtkTable* history = filter->GetHistory();
  const vtkIdType rows = history->GetNumberOfRows();
  return history->GetValueByName(row < 0 ? rows + row : row, column).ToDouble();
}

double MeanResidual(vtkPolyData* surface)
{
  vtkDataArray* residual = surface->GetPointData()->GetArray("Residual");
  double sum = 0;
  for (vtkIdType i = 0; i < residual->GetNumberOfTuples(); ++i)
  {
    sum += std::abs(residual->GetComponent(i, 0));
  }
  return sum / static_cast<double>(residual->GetNumberOfTuples());
}
}

namespace
{
/** A property as a number, and a value that is not its default. */
struct Property
{
  std::string Name;
  std::function<void(vtkDeformableSurface&)> Set;
  std::function<double(vtkDeformableSurface&)> Get;
  double Value;
};

#define VolumicTestedProperty(name, value)                                                         \
  Property                                                                                         \
  {                                                                                                \
    #name, [](vtkDeformableSurface& f) { f.Set##name(value); },                                    \
      [](vtkDeformableSurface& f) { return static_cast<double>(f.Get##name()); }, value            \
  }

std::vector<Property> AllProperties()
{
  return {
    VolumicTestedProperty(SelectedComponent, 2),
    VolumicTestedProperty(NaNIsBackground, 0),
    VolumicTestedProperty(Metric, 0),
    VolumicTestedProperty(EdgeLength, 2.5),
    VolumicTestedProperty(Tolerance, 0.25),
    VolumicTestedProperty(MaximumEdgeLength, 4.5),
    VolumicTestedProperty(Gradation, 0.3),
    VolumicTestedProperty(ThinParts, 1),
    VolumicTestedProperty(IsoValue, 7),
    VolumicTestedProperty(ObjectIsBright, 0),
    VolumicTestedProperty(Initialization, 3),
    VolumicTestedProperty(SeedRadius, 1.5),
    VolumicTestedProperty(CoarsestLevel, 4),
    VolumicTestedProperty(FinestLevel, 1),
    VolumicTestedProperty(SamplingRatio, 0.75),
    VolumicTestedProperty(TensionWeight, 0.25),
    VolumicTestedProperty(ElasticityWeight, 0.5),
    VolumicTestedProperty(IsopotentialWeight, 0.375),
    VolumicTestedProperty(GradientWeight, 0.125),
    VolumicTestedProperty(PointAttractionWeight, 0.625),
    VolumicTestedProperty(EdgeAttractionWeight, 0.875),
    VolumicTestedProperty(Friction, 6),
    VolumicTestedProperty(BorderValue, 1),
    VolumicTestedProperty(Recovery, 2),
    VolumicTestedProperty(MinimumPartSize, 30),
    VolumicTestedProperty(KeepComponents, 3),
    VolumicTestedProperty(MinimumComponentVolume, 9),
    VolumicTestedProperty(TopologyChanges, 0),
    VolumicTestedProperty(MaximumNumberOfIterations, 11),
    VolumicTestedProperty(ConvergenceTolerance, 0.25),
    VolumicTestedProperty(FreezeMotionlessVertices, 0),
    VolumicTestedProperty(SnapToIsoValue, 0),
    VolumicTestedProperty(NumberOfThreads, 3),
    VolumicTestedProperty(MemoryLimit, 4000),
    VolumicTestedProperty(Resume, true),
    VolumicTestedProperty(TimeLimit, 12),
    VolumicTestedProperty(Preview, 1),
    VolumicTestedProperty(ShowLevels, 1),
    VolumicTestedProperty(Profile, 1),
    VolumicTestedProperty(SnapshotInterval, 13),
  };
}

bool AreSame(double a, double b)
{
  return a == b || (std::isnan(a) && std::isnan(b));
}
}

TEST(DeformableSurfaceProperties, EachHasAValueOfItsOwn)
{
  const std::vector<Property> all = AllProperties();
  const auto usual = vtkSmartPointer<vtkDeformableSurface>::New();
  for (const Property& changed : all)
  {
    const auto filter = vtkSmartPointer<vtkDeformableSurface>::New();
    ASSERT_NE(changed.Get(*filter), changed.Value) << changed.Name;
    const vtkMTimeType before = filter->GetMTime();
    changed.Set(*filter);
    const vtkMTimeType after = filter->GetMTime();
    EXPECT_GT(after, before) << changed.Name;
    changed.Set(*filter);
    EXPECT_EQ(filter->GetMTime(), after) << changed.Name;
    for (const Property& other : all)
    {
      const double expected = other.Name == changed.Name ? changed.Value : other.Get(*usual);
      EXPECT_TRUE(AreSame(other.Get(*filter), expected)) << changed.Name << ", " << other.Name;
    }
    std::ostringstream printed;
    std::ostringstream line;
    filter->Print(printed);
    line << "  " << changed.Name << ": " << changed.Value << "\n";
    EXPECT_TRUE(Has(printed.str(), line.str())) << line.str();
  }
}

TEST(DeformableSurfaceProperties, TheScratchDirectoryIsAText)
{
  const auto check = [](auto* filter)
  {
    EXPECT_STREQ(filter->GetScratchDirectory(), "");
    const vtkMTimeType before = filter->GetMTime();
    filter->SetScratchDirectory(nullptr);
    EXPECT_EQ(filter->GetMTime(), before) << "null is empty";
    filter->SetScratchDirectory("/some/folder");
    EXPECT_GT(filter->GetMTime(), before);
    EXPECT_STREQ(filter->GetScratchDirectory(), "/some/folder");
    std::ostringstream printed;
    filter->Print(printed);
    EXPECT_TRUE(Has(printed.str(), "  ScratchDirectory: /some/folder\n"));
  };
  check(vtkSmartPointer<vtkDeformableSurface>::New().Get());
  check(vtkSmartPointer<vtkImagePyramid>::New().Get());
}

TEST(DeformableSurfaceProperties, WeightsChangeTheSurface)
{
  const auto usual = SurfaceWith([](vtkDeformableSurface&) {});
  using Setter = std::function<void(vtkDeformableSurface&)>;
  const Setter setters[] = { [](vtkDeformableSurface& f) { f.SetTensionWeight(0.5); },
    [](vtkDeformableSurface& f) { f.SetElasticityWeight(0.3); },
    [](vtkDeformableSurface& f) { f.SetIsopotentialWeight(0.7); },
    [](vtkDeformableSurface& f) { f.SetGradientWeight(0.2); } };
  int number = 0;
  for (const Setter& set : setters)
  {
    EXPECT_FALSE(AreSameSurfaces(usual->GetOutput(), SurfaceWith(set)->GetOutput())) << number;
    ++number;
  }
}

TEST(DeformableSurfaceProperties, FrictionSetsTheTimeStep)
{
  // A vertex at its final speed goes the largest step; on the edges of the box it is faster.
  for (const double friction : { 3., 6. })
  {
    const auto filter = SurfaceWith([=](vtkDeformableSurface& f) { f.SetFriction(friction); });
    EXPECT_NEAR(History(filter, 5, "TimeStep"), 0.45 * friction, 0.05 * friction);
  }
}

TEST(DeformableSurfaceProperties, ToleranceAndLimitEndALevel)
{
  // Where vertices may freeze it rests as soon as all have.
  const auto usual =
    SurfaceWith([](vtkDeformableSurface& f) { f.FreezeMotionlessVerticesOff(); });
  const auto rough = SurfaceWith(
    [](vtkDeformableSurface& f)
    {
      f.FreezeMotionlessVerticesOff();
      f.SetConvergenceTolerance(0.1);
    });
  const auto cut = SurfaceWith([](vtkDeformableSurface& f) { f.SetMaximumNumberOfIterations(7); });
  EXPECT_LT(rough->GetHistory()->GetNumberOfRows(), usual->GetHistory()->GetNumberOfRows());
  EXPECT_EQ(StopReason(rough->GetOutput()), "converged");
  EXPECT_EQ(cut->GetHistory()->GetNumberOfRows(), 7);
  EXPECT_EQ(StopReason(cut->GetOutput()), "iteration limit");
}

TEST(DeformableSurfaceProperties, FreezingAndSnappingCanBeLeftOut)
{
  const auto usual = SurfaceWith([](vtkDeformableSurface&) {});
  const auto active = SurfaceWith([](vtkDeformableSurface& f) { f.FreezeMotionlessVerticesOff(); });
  const auto share = [](vtkDeformableSurface* f)
  { return History(f, -1, "ActiveVertices") / History(f, -1, "Vertices"); };
  EXPECT_LT(share(usual), 0.5);
  EXPECT_GT(share(active), 0.99);
  const auto loose = SurfaceWith([](vtkDeformableSurface& f) { f.SnapToIsoValueOff(); });
  EXPECT_GT(MeanResidual(loose->GetOutput()), 2 * MeanResidual(usual->GetOutput()));
}

TEST(DeformableSurfaceProperties, SamplingRatioSetsDelta)
{
  for (const double ratio : { 0.7, 1. })
  {
    const auto filter = SurfaceWith([=](vtkDeformableSurface& f) { f.SetSamplingRatio(ratio); });
    EXPECT_NEAR(FieldOf(filter->GetOutput(), "Delta"), ratio, 1e-6);
  }
}
