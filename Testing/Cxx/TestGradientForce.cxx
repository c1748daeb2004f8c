// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// An object with a shading across the volume, which no iso-value segments: descent along the
// gradient of the negative gradient magnitude, whose valleys are the boundaries, does.
#include "SupportVtkConversions.h"
#include "SurfaceJudge.h"
#include "SyntheticScenes.h"
#include "vtkDeformableSurface.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageGradientMagnitude.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace volumic::support;

namespace
{
/// Voxels that are on the wrong side of a closed surface, as a share of the object's. The surface
/// is in index coordinates; sides are found by counting crossings along rows of voxels.
double ShareOfWrongVoxels(const TriangleSurface& surface, const Scene& scene)
{
  const auto [nx, ny, nz] = scene.Size;
  // Crossings of the rows, a little beside the voxels so that no row meets an edge.
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(ny) * nz);
  const double dy = 1.234567e-4;
  const double dz = 2.345678e-4;
  for (const auto& triangle : surface.Triangles)
  {
    const auto& a = surface.Points[triangle[0]];
    const auto& b = surface.Points[triangle[1]];
    const auto& c = surface.Points[triangle[2]];
    const auto range = [&](int axis, double shift, int n)
    {
      const auto limits = std::minmax({ a[axis], b[axis], c[axis] });
      return std::make_pair(std::max(0, static_cast<int>(std::ceil(limits.first - shift))),
        std::min(n - 1, static_cast<int>(std::floor(limits.second - shift))));
    };
    const auto rows = range(1, dy, ny);
    const auto slices = range(2, dz, nz);
    for (int k = slices.first; k <= slices.second; ++k)
    {
      for (int j = rows.first; j <= rows.second; ++j)
      {
        const double y = j + dy;
        const double z = k + dz;
        const auto side = [&](const std::array<double, 3>& p, const std::array<double, 3>& q)
        { return (q[1] - p[1]) * (z - p[2]) - (q[2] - p[2]) * (y - p[1]); };
        const double u = side(b, c);
        const double v = side(c, a);
        const double w = side(a, b);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))
        {
          crossings[static_cast<std::size_t>(k) * ny + j].push_back(
            (u * a[0] + v * b[0] + w * c[0]) / (u + v + w));
        }
      }
    }
  }
  std::size_t wrong = 0;
  std::size_t index = 0;
  for (int k = 0; k < nz; ++k)
  {
    for (int j = 0; j < ny; ++j)
    {
      const auto& row = crossings[static_cast<std::size_t>(k) * ny + j];
      for (int i = 0; i < nx; ++i, ++index)
      {
        const auto before = std::count_if(row.begin(), row.end(), [i](double x) { return x < i; });
        wrong += (before % 2 == 1) != (scene.Inside[index] != 0) ? 1 : 0;
      }
    }
  }
  const auto object = std::count(scene.Inside.begin(), scene.Inside.end(), 1);
  return static_cast<double>(wrong) / static_cast<double>(object);
}

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

/// What the valleys of the potential are: where the gradient is largest.
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
