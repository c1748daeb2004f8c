// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// An object with a shading across the volume, which no iso-value segments: descent along the
// gradient of the negative gradient magnitude, whose valleys are the boundaries, does.
#include "SupportVtkConversions.h"
#include "TestPrelude.h"
#include "WrongVoxels.h"
#include "vtkDeformableSurface.h"

#include <vtkImageGradientMagnitude.h>

using namespace volumic::support;

namespace
{
double BestShareByIsoValue(vtkImageData* image, const Scene& scene)
{
  double range[2];
  image->GetScalarRange(range);
  double best = 1e9;
  for (int step = 1; step < 6; ++step)
  {
    vtkNew<vtkDeformableSurface> filter;
    filter->SetInputData(image);
    filter->SetCoarsestLevel(0);
    filter->SetIsoValue(range[0] + (range[1] - range[0]) * step / 6.0);
    filter->Update();
    best = std::min(best, ShareOfWrongVoxels(ToTriangleSurface(filter->GetOutput(), image), scene));
  }
  return best;
}

/** What the valleys of the potential are: where the gradient is largest. */
vtkSmartPointer<vtkImageData> NegativeGradientMagnitude(vtkImageData* image)
{
  vtkNew<vtkImageGradientMagnitude> gradient;
  gradient->SetInputData(image);
  gradient->SetDimensionality(3);
  gradient->HandleBoundariesOn();
  gradient->Update();
  vtkSmartPointer<vtkImageData> potential = gradient->GetOutput();
  vtkDataArray* values = potential->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    values->SetComponent(i, 0, -values->GetComponent(i, 0));
  }
  values->Modified();
  return potential;
}
}

TEST(GradientForce, SegmentsWhatNoIsoValueDoes)
{
  const Scene scene = MakeScene(SceneKind::ShadedEllipsoid);
  ASSERT_FALSE(scene.OneIsoValueFits);
  const auto image = ToImage(scene);
  const double byIsoValue = BestShareByIsoValue(image, scene);

  const auto potential = NegativeGradientMagnitude(image);
  double range[2];
  potential->GetScalarRange(range);
  vtkNew<vtkDeformableSurface> filter;
  filter->SetInputData(potential);
  // The isopotential brings the surface to the edge's foot, from where the gradient takes it down.
  filter->SetIsoValue(0.3 * range[0]);
  filter->ObjectIsBrightOff();
  filter->SetIsopotentialWeight(0.3);
  filter->SetGradientWeight(2.0);
  filter->SnapToIsoValueOff();
  filter->SetRecovery(vtkDeformableSurface::NoRecovery);
  filter->SetCoarsestLevel(1);
  filter->Update();
  const TriangleSurface surface = ToTriangleSurface(filter->GetOutput(), potential);
  const TopologyVerdict topology = JudgeTopology(surface);
  EXPECT_TRUE(topology.Outward);
  EXPECT_EQ(topology.Components.size(), 1u);
  EXPECT_EQ(topology.Genus, 0);
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 0u);
  const double byGradient = ShareOfWrongVoxels(surface, scene);
  EXPECT_LT(byGradient, 0.02);
  EXPECT_GT(byIsoValue, 5 * byGradient) << "the scene must be one that needs it";
}
