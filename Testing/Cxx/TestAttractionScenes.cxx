// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Attraction by points closes gaps. Attraction by edges segments objects without a fitting
// iso-value.
#include "MisclassifiedVoxels.h"
#include "SupportVtkConversions.h"
#include "SurfaceTestTools.h"

#include <vtkDoubleArray.h>
#include <vtkImageGradientMagnitude.h>
#include <vtkMath.h>

using namespace volumic;
using namespace volumic::support;

namespace
{
constexpr double Pi = 3.14159265358979;
/** Outer radius of SceneKind::ShellWithOpening at 64 voxels. */
constexpr double OuterRadius = 26.0;
double BallVolume(double radius)
{
  return 4.0 / 3.0 * Pi * radius * radius * radius;
}

/** Return a point at the centre of the opening and six around it. */
vtkSmartPointer<vtkPolyData> PointsInTheOpening(const Scene& scene)
{
  // The seed of the scene is in the wall, opposite to the opening.
  const double middle = 0.5 * (scene.Size[0] - 1);
  std::array<std::array<double, 3>, 3> axes; // the first is that of the opening
  for (int a = 0; a < 3; ++a)
  {
    axes[0][a] = middle - scene.Seeds[0][a];
  }
  const double height = vtkMath::Normalize(axes[0].data());
  vtkMath::Perpendiculars(axes[0].data(), axes[1].data(), axes[2].data(), 0.0);
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 7; ++i)
  {
    const double x = i == 0 ? 0.0 : 5.0 * std::cos(i * Pi / 3);
    const double y = i == 0 ? 0.0 : 5.0 * std::sin(i * Pi / 3);
    const auto at = [&](int a)
    { return middle + height * axes[0][a] + x * axes[1][a] + y * axes[2][a]; };
    points->InsertNextPoint(at(0), at(1), at(2));
  }
  vtkNew<vtkDoubleArray> radius;
  radius->SetName("Radius");
  radius->SetNumberOfTuples(points->GetNumberOfPoints());
  radius->Fill(5.0);
  auto polyData = vtkSmartPointer<vtkPolyData>::New();
  polyData->SetPoints(points);
  polyData->GetPointData()->AddArray(radius);
  return polyData;
}

vtkSmartPointer<vtkDeformableSurface> FilterAt(vtkDataObject* input, double isoValue)
{
  return FilterOf(input, [=](vtkDeformableSurface* filter) { filter->SetIsoValue(isoValue); });
}

SurfaceVerdict JudgeOutput(vtkDeformableSurface* filter)
{
  filter->Update();
  vtkPolyData* surface = filter->GetOutput();
  const SurfaceVerdict verdict =
    JudgeSurface(ToTriangleSurface(surface), FieldOf(surface, "Delta"));
  EXPECT_TRUE(verdict.IsSound()) << Describe(verdict);
  EXPECT_EQ(verdict.Lengths.EdgesTooShort + verdict.Lengths.EdgesTooLong, 0u);
  EXPECT_EQ(verdict.Lengths.NearPairs, 0u);
  EXPECT_EQ(StopReason(surface), "converged");
  return verdict;
}

double VolumeOf(vtkDeformableSurface* filter)
{
  return FieldOf(filter->GetOutput(), "Volume");
}

vtkSmartPointer<vtkImageData> GradientMagnitude(vtkImageData* image)
{
  vtkNew<vtkImageGradientMagnitude> gradient;
  gradient->SetInputData(image);
  gradient->SetDimensionality(3);
  gradient->HandleBoundariesOn();
  gradient->Update();
  return gradient->GetOutput();
}

/** Return the scene with its gradient magnitude as array `Edges`. */
vtkSmartPointer<vtkImageData> WithEdges(const Scene& scene)
{
  const auto image = ToImage(scene);
  const auto gradient = GradientMagnitude(image);
  vtkDataArray* edges = gradient->GetPointData()->GetScalars();
  edges->SetName("Edges");
  image->GetPointData()->AddArray(edges);
  return image;
}

/** Return a filter whose iso-value is so high that only the edges stop the surface. */
vtkSmartPointer<vtkDeformableSurface> EdgeFilterOf(vtkDataObject* input, const Scene& scene)
{
  const double brightest = *std::max_element(scene.Values.begin(), scene.Values.end());
  auto filter = FilterAt(input, 0.5 * (scene.IsoValue + brightest));
  filter->SetEdgeAttractionWeight(2.0);
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Edges");
  return filter;
}
}

TEST(PointAttractionScene, ClosesGapWithFewPoints)
{
  const Scene scene = MakeScene(SceneKind::ShellWithOpening);
  const auto image = ToImage(scene);
  const auto leaking = FilterAt(image, scene.IsoValue);
  JudgeOutput(leaking);
  EXPECT_LT(VolumeOf(leaking), 0.7 * BallVolume(OuterRadius))
    << "the scene must leak without points";

  const auto closed = FilterAt(image, scene.IsoValue);
  closed->SetAttractingPointsData(PointsInTheOpening(scene));
  const SurfaceVerdict verdict = JudgeOutput(closed);
  EXPECT_EQ(verdict.Topology.Components.size(), 1u);
  EXPECT_EQ(verdict.Topology.Genus, 0);
  EXPECT_NEAR(VolumeOf(closed) / BallVolume(OuterRadius), 1.0, 0.02);

  closed->SetPointAttractionWeight(0.0);
  closed->Update();
  EXPECT_EQ(VolumeOf(closed), VolumeOf(leaking));
}

TEST(EdgeAttractionScene, SegmentsShadedObject)
{
  const Scene scene = MakeScene(SceneKind::ShadedEllipsoid);
  const auto image = WithEdges(scene);
  vtkNew<vtkImagePyramid> pyramid; // without edges: the filter computes their pyramid
  pyramid->SetInputData(image);
  pyramid->SetReductionFactor(1.5);
  pyramid->Update();
  for (vtkDataObject* input :
    { static_cast<vtkDataObject*>(image), pyramid->GetOutputDataObject(0) })
  {
    const auto filter = EdgeFilterOf(input, scene);
    const SurfaceVerdict verdict = JudgeOutput(filter);
    EXPECT_EQ(verdict.Topology.Components.size(), 1u);
    EXPECT_EQ(verdict.Topology.Genus, 0);
    EXPECT_LT(MisclassifiedFraction(ToTriangleSurface(filter->GetOutput()), scene), 0.03);
  }
}

TEST(GradientForce, SegmentsShadedObject)
{
  // The boundaries are the minima of the negative gradient magnitude.
  const Scene scene = MakeScene(SceneKind::ShadedEllipsoid);
  const auto potential = GradientMagnitude(ToImage(scene));
  vtkDataArray* values = potential->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    values->SetComponent(i, 0, -values->GetComponent(i, 0));
  }
  values->Modified();
  // The isopotential force moves the surface near the boundary, the gradient force onto it.
  const auto filter = FilterAt(potential, 0.3 * potential->GetScalarRange()[0]);
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
  EXPECT_LT(MisclassifiedFraction(surface, scene), 0.02);
}
