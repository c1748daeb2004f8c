// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Every property of the filter reaches the surface: what it does there, the tests of the core tell.
#include "SurfaceTestTools.h"

#include <vtkTable.h>
#include <vtkVariant.h>

#include <functional>

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
  // A vertex at its final speed goes the largest step.
  for (const double friction : { 3., 6. })
  {
    const auto filter = SurfaceWith([=](vtkDeformableSurface& f) { f.SetFriction(friction); });
    EXPECT_NEAR(History(filter, 5, "TimeStep"), 0.5 * friction, 0.05 * friction);
  }
}

TEST(DeformableSurfaceProperties, ToleranceAndLimitEndALevel)
{
  const auto usual = SurfaceWith([](vtkDeformableSurface&) {});
  const auto rough = SurfaceWith([](vtkDeformableSurface& f) { f.SetConvergenceTolerance(0.1); });
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
