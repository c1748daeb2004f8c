// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceSizes.h"

#include "Core/Interfaces/MakeInterfaces.h"
#include "Core/Interfaces/TriangleShape.h"
#include "InterfaceTestTools.h"

using namespace volumic;

namespace
{
constexpr double Tolerance = 0.2;

InterfaceMesh Make(InterfaceScene& scene, double tolerance, Executor& executor = OnThisThread(),
  const std::function<bool(double)>& goOn = [](double) { return true; })
{
  InterfaceOptions options;
  options.Tolerance = tolerance;
  return MakeInterfaces(*scene.Fields, options, executor, goOn);
}

Fit FitOf(const InterfaceMesh& mesh, const InterfaceScene& scene)
{
  std::vector<int> faces(mesh.Faces.size());
  std::iota(faces.begin(), faces.end(), 0);
  return MeasureFit(mesh, *scene.Fields, faces, Tolerance);
}

double MeanRatio(const InterfaceMesh& mesh)
{
  double sum = 0.;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    sum += RadiusRatio(TriangleOf(mesh, face.Vertex));
  }
  return sum / static_cast<double>(mesh.Faces.size());
}

float LargestSize(const InterfaceMesh& mesh)
{
  return *std::max_element(mesh.Size.begin(), mesh.Size.end());
}

/** By how much sizes grow per length at most, between any two vertices. */
double SteepestSize(const InterfaceMesh& mesh)
{
  double steepest = 0.;
  for (std::size_t v = 0; v < mesh.Size.size(); ++v)
  {
    for (std::size_t w = 0; w < v; ++w)
    {
      const double way = Length(mesh.Position[v] - mesh.Position[w]);
      steepest = std::max(steepest, std::abs(mesh.Size[v] - mesh.Size[w]) / way);
    }
  }
  return steepest;
}
}

TEST(InterfaceSizes, MakeFewerTrianglesThatKeepTheTolerance)
{
  InterfaceScene uniform(ManyCells(40, 9, 2));
  InterfaceScene graded(ManyCells(40, 9, 2));
  const InterfaceMesh all = Make(uniform, 0.);
  const InterfaceMesh mesh = Make(graded, Tolerance);
  ExpectSound(mesh);
  EXPECT_EQ(EulerCharacteristicOf(mesh), EulerCharacteristicOf(all));
  EXPECT_LT(static_cast<double>(mesh.Position.size()),
    0.65 * static_cast<double>(all.Position.size()));
  // Where the map is bent more than edges are long it is not kept with the shortest ones either.
  EXPECT_GT(FitOf(all, uniform).WithinTolerance, 0.9);
  EXPECT_GT(FitOf(mesh, graded).WithinTolerance, FitOf(all, uniform).WithinTolerance - 0.03);
  EXPECT_GT(MeanRatio(mesh), 0.92);
  for (int object = 1; object <= 9; ++object)
  {
    const auto voxels = static_cast<double>(graded.Bricks->ExtentOf(object).Voxels);
    if (voxels > 1000.)
    {
      EXPECT_NEAR(VolumeOf(mesh, object) / voxels, 1., 2e-3) << object;
    }
  }
}

TEST(InterfaceSizes, GrowWhereInterfacesAreFlatAndKeepTheGradation)
{
  InterfaceScene scene(FourBlocks(10));
  InterfaceMesh mesh = Make(scene, 0.);
  EXPECT_EQ(LargestSize(mesh), 1.f);
  const SizeBounds bounds = { 0.1, 2.5, 1.8, 0.2 };
  InterfaceMesh off = mesh;
  for (Vector& p : off.Position)
  {
    p += Vector(0.2f, 0.2f, 0.2f); // on purpose, as junction lines are, to be straight
  }
  AdjustSizes(off, *scene.Fields, bounds, OnThisThread());
  EXPECT_EQ(LargestSize(off), 1.8f);
  AdjustSizes(mesh, *scene.Fields, bounds, OnThisThread());
  EXPECT_LT(SteepestSize(mesh), 1.001 * bounds.Gradation);
  EXPECT_EQ(LargestSize(mesh), 1.8f);
  EXPECT_EQ(*std::min_element(mesh.Size.begin(), mesh.Size.end()), 1.f); // at edges of the cube
}

class GradedInterfaces : public testing::TestWithParam<int>
{
};

TEST_P(GradedInterfaces, AreSoundWhateverTheMap)
{
  const auto seed = static_cast<unsigned>(GetParam());
  InterfaceScene scene(ManyCells(26, 3 + 4 * GetParam(), seed));
  const InterfaceMesh mesh = Make(scene, 0.1 * (1 + GetParam()));
  ExpectSound(mesh);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GradedInterfaces, testing::Range(1, 4));
