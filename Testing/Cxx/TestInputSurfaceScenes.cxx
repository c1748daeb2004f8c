// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Initial surfaces of VTK's sources and decimated scans. Invalid ones must be rejected.
#include "EvolutionTestTools.h"
#include "SupportVtkConversions.h"

#include <vtkCleanPolyData.h>
#include <vtkConeSource.h>
#include <vtkCylinderSource.h>
#include <vtkFlyingEdges3D.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkQuadricDecimation.h>
#include <vtkSphereSource.h>
#include <vtkTriangleFilter.h>

using namespace volumic;
using namespace volumic::support;

namespace
{
constexpr int Size = 40;
constexpr double Middle = 19.5;

/** Random numbers, reproducible with any standard library. */
class Dice
{
public:
  explicit Dice(unsigned int seed) : Engine(seed) {}
  double Between(double low, double high)
  {
    return low + (high - low) * (static_cast<double>(this->Engine()) / 4294967296.0);
  }
  /** Logarithmic distribution. */
  int Count(int low, int high)
  {
    return static_cast<int>(std::exp(this->Between(std::log(low), std::log(high))));
  }

private:
  std::mt19937 Engine;
};

vtkSmartPointer<vtkPolyData> Cleaned(vtkAlgorithmOutput* polygons)
{
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputConnection(polygons);
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(triangulate->GetOutputPort());
  clean->Update();
  return clean->GetOutput();
}

/** Return a decimated isosurface of a bumpy ball. */
vtkSmartPointer<vtkPolyData> Decimated(Dice& dice)
{
  double wave[12];
  double phase[4];
  for (double& w : wave)
  {
    w = dice.Between(0.1, 0.5);
  }
  for (double& p : phase)
  {
    p = dice.Between(0.0, 6.28);
  }
  const double height = dice.Between(0.5, 3.0);
  vtkNew<vtkImageData> image;
  image->SetDimensions(Size, Size, Size);
  image->SetOrigin(-Middle, -Middle, -Middle);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* value = static_cast<float*>(image->GetScalarPointer());
  ForVoxels({ Size, Size, Size },
    [&](int i, int j, int k)
    {
      double bumps = 0.0;
      for (int m = 0; m < 4; ++m)
      {
        bumps += std::sin(wave[3 * m] * i + wave[3 * m + 1] * j + wave[3 * m + 2] * k + phase[m]);
      }
      const double r = std::hypot(i - Middle, j - Middle, k - Middle);
      *value++ = static_cast<float>(r > 18.0 ? -3.0 : 13.0 - r + height * bumps);
    });
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0.013);
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputConnection(contour->GetOutputPort());
  largest->SetExtractionModeToLargestRegion();
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(largest->GetOutputPort());
  clean->SetTolerance(0.0);
  vtkNew<vtkQuadricDecimation> decimate;
  decimate->SetInputConnection(clean->GetOutputPort());
  decimate->SetTargetReduction(dice.Between(0.2, 0.97));
  return Cleaned(decimate->GetOutputPort());
}

vtkSmartPointer<vtkPolyData> MakeShape(const std::string& kind, Dice& dice)
{
  const double radius = dice.Between(3.0, 16.0);
  const double height = dice.Between(3.0, 32.0);
  const int sides = dice.Count(3, 300);
  const auto shapeOf = [&](auto source, double more)
  {
    source->SetRadius(radius + more);
    source->SetHeight(height + 2.0 * more);
    source->SetResolution(sides);
    return Cleaned(source->GetOutputPort());
  };
  if (kind == "Cylinders")
  {
    return shapeOf(vtkSmartPointer<vtkCylinderSource>::New(), 0.0);
  }
  if (kind == "Cones")
  {
    return shapeOf(vtkSmartPointer<vtkConeSource>::New(), 2.0);
  }
  if (kind == "Spheres")
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(radius);
    sphere->SetThetaResolution(sides);
    sphere->SetPhiResolution(dice.Count(4, 200));
    return Cleaned(sphere->GetOutputPort());
  }
  return Decimated(dice);
}

/** Rotate a shape and move it to the centre of the image. */
IndexedSurface Placed(vtkPolyData* shape, Dice& dice)
{
  const double angle = dice.Between(0.0, 1.0) < 0.3 ? 0.0 : dice.Between(0.0, 6.28);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const TriangleSurface given = ToTriangleSurface(shape);
  IndexedSurface surface;
  surface.Triangles.assign(given.Triangles.begin(), given.Triangles.end());
  for (const auto& p : given.Points)
  {
    const double x = c * p[0] - s * p[1];
    const double y = s * p[0] + c * p[1];
    surface.Points.push_back({ x + Middle, c * y - s * p[2] + Middle, s * y + c * p[2] + Middle });
  }
  return surface;
}

TriangleSurface Judged(const IndexedSurface& surface)
{
  TriangleSurface judged;
  judged.Points.assign(surface.Points.begin(), surface.Points.end());
  judged.Triangles.assign(surface.Triangles.begin(), surface.Triangles.end());
  return judged;
}

void ExpectLegal(const SurfaceResult& surface, const char* when)
{
  const SurfaceVerdict verdict = JudgeSurface(Judged(surface), surface.Delta);
  SCOPED_TRACE(std::string(when) + "\n" + Describe(verdict));
  EXPECT_TRUE(verdict.IsSound());
  EXPECT_LE(verdict.Lengths.Longest, 2.5001 * surface.Delta);
  EXPECT_GE(verdict.Lengths.Shortest, 0.2 * surface.Delta);
  EXPECT_LE(verdict.Lengths.EdgesTooShort, verdict.Lengths.Edges / 50 + 3);
}
}

class InputSurfaces : public ::testing::TestWithParam<const char*>
{
};

TEST_P(InputSurfaces, AreValidAtStartAndEnd)
{
  const TestVolume volume = MakeVolume(Size,
    [](double x, double y, double z)
    { return Soft(Distance(x, y, z, Middle, Middle, Middle) - 12.0); });
  int accepted = 0;
  constexpr int rounds = 10;
  for (unsigned int seed = 1; seed <= rounds; ++seed)
  {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    const IndexedSurface given = Placed(MakeShape(GetParam(), dice), dice);
    TestEvolution evolution(IsoHalf(), Threads, Silent);
    try
    {
      evolution.StartSurface(volume.Image, 0, given);
    }
    catch (const std::invalid_argument& error)
    {
      // Decimated surfaces may be invalid, shapes may be too thin.
      const TopologyVerdict topology = JudgeTopology(Judged(given));
      const bool isBroken = !topology.Outward || JudgeIntersections(Judged(given)).Pairs > 0;
      EXPECT_TRUE(isBroken || std::string(error.what()).find("too thin") != std::string::npos)
        << error.what();
      continue;
    }
    ++accepted;
    ExpectLegal(evolution.Result(), "at the start");
    EXPECT_EQ(evolution.Run(), StopReason::Converged);
    ExpectLegal(evolution.Result(), "at the end");
    EXPECT_EQ(JudgeTopology(Judged(evolution.Result())).Genus, 0);
  }
  EXPECT_GE(accepted, rounds / 2);
}

INSTANTIATE_TEST_SUITE_P(Starts, InputSurfaces,
  ::testing::Values("Cylinders", "Cones", "Spheres", "DecimatedScans"),
  [](const ::testing::TestParamInfo<const char*>& start) { return std::string(start.param); });
