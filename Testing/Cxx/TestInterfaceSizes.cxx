// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceSizes.h"

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceRemesher.h"
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

TEST(InterfaceSizes, HaveLinesAsNearAsTheTolerance)
{
  InterfaceScene scene(ManyCells(40, 9, 2));
  const InterfaceMesh mesh = Make(scene, 0.05);
  std::vector<float> off;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    for (const int v : face.Vertex)
    {
      if (mesh.StratumOf[static_cast<std::size_t>(v)] == Stratum::Line)
      {
        const Vector& place = mesh.Position[static_cast<std::size_t>(v)];
        off.push_back(std::abs(scene.Fields->Between(face.Behind, face.Front, place).Value));
      }
    }
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 0.06f); // Some are held by what is thin.
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

TEST(InterfaceSizes, ShrinkWhereTheToleranceIsNotKept)
{
  InterfaceScene scene(MakeLabelMap({ 32, 32, 32 }, 1,
    [](int i, int j, int k) { return std::hypot(i - 16., j - 16., k - 16.) < 7. ? 1 : 0; }));
  InterfaceMesh mesh = Make(scene, 0.);
  std::fill(mesh.Size.begin(), mesh.Size.end(), 4.f);
  // In the middle of an edge of 1.36 a sphere of radius 7 is .033 off.
  AdjustSizes(mesh, *scene.Fields, { 0.01, 2., 4., 1. }, OnThisThread());
  EXPECT_LT(LargestSize(mesh), 3.f);
  EXPECT_GT(LargestSize(mesh), 2.f); // No change is more than that of a level.
}

TEST(InterfaceSizes, AreLengthsOfEdgesThatAreEdited)
{
  InterfaceScene scene(FourBlocks(8));
  InterfaceMesh mesh = Make(scene, 0.);
  const std::size_t vertices = mesh.Position.size();
  std::fill(mesh.Size.begin(), mesh.Size.end(), 2.f);
  InterfaceRemesher coarser(mesh, 0.8 * 1.36, 4. / 3. * 1.36, 1e-3, OnThisThread(), [] { return true; });
  EXPECT_EQ(coarser.SplitLongEdges(), 0);
  EXPECT_GT(coarser.CollapseShortEdges(), 0);
  mesh.Compact();
  EXPECT_LT(mesh.Position.size(), vertices / 2);
  ExpectSound(mesh);
  std::fill(mesh.Size.begin(), mesh.Size.end(), 0.5f);
  InterfaceRemesher finer(mesh, 0.8 * 1.36, 4. / 3. * 1.36, 1e-3, OnThisThread(), [] { return true; });
  int rounds = 0;
  while (finer.SplitLongEdges() > 0)
  {
    ++rounds;
  }
  EXPECT_GT(rounds, 0);
  EXPECT_EQ(LargestSize(mesh), 0.5f); // New vertices have those of their edges.
  for (const auto& edge : FacesAtEdges(mesh))
  {
    const auto at = [&](int k) { return mesh.Position[static_cast<std::size_t>(edge.first[k])]; };
    ASSERT_LT(Length(at(1) - at(0)), 0.5 * 4. / 3. * 1.3601);
  }
}

TEST(InterfaceSizes, GiveTheSameBitsWithThreads)
{
  InterfaceScene one(ManyCells(32, 8, 6));
  InterfaceScene other(ManyCells(32, 8, 6));
  const InterfaceMesh mesh = Make(one, Tolerance);
  Executor threads(3);
  const InterfaceMesh same = Make(other, Tolerance, threads);
  ASSERT_EQ(same.Position.size(), mesh.Position.size());
  ASSERT_EQ(same.Faces.size(), mesh.Faces.size());
  EXPECT_EQ(same.Size, mesh.Size);
  for (std::size_t v = 0; v < mesh.Position.size(); ++v)
  {
    ASSERT_EQ(SquaredDistance(same.Position[v], mesh.Position[v]), 0.f);
  }
  for (std::size_t f = 0; f < mesh.Faces.size(); ++f)
  {
    ASSERT_EQ(same.Faces[f].Vertex, mesh.Faces[f].Vertex);
  }
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

TEST_P(GradedInterfaces, AreSoundWhereTheyAreStopped)
{
  InterfaceScene scene(ManyCells(26, 6, 4));
  int asked = 0;
  const InterfaceMesh mesh =
    Make(scene, Tolerance, OnThisThread(), [&](double) { return ++asked < 12 + 4 * GetParam(); });
  ExpectSound(mesh);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GradedInterfaces, testing::Range(1, 4));
