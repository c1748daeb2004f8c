// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MakeInterfaces.h"

#include "Core/Interfaces/InterfaceFit.h"
#include "Core/Interfaces/TriangleShape.h"
#include "InterfaceTestTools.h"

using namespace volumic;

namespace
{
bool IsOffLines(const InterfaceMesh& mesh, const InterfaceMesh::Face& face)
{
  return std::all_of(face.Vertex.begin(), face.Vertex.end(),
    [&](int v)
    { return mesh.StratumOf[static_cast<std::size_t>(v)] == Stratum::Interface; });
}

InterfaceMesh Make(InterfaceScene& scene, Executor& executor = OnThisThread(),
  const std::function<bool(double)>& goOn = [](double) { return true; })
{
  return MakeInterfaces(*scene.Fields, InterfaceOptions(), executor, goOn);
}

double VoxelsOf(const InterfaceScene& scene, int object)
{
  return static_cast<double>(scene.Bricks->ExtentOf(object).Voxels);
}
}

TEST(MakeInterfaces, KeepsVolumesAndVoxelsWithGoodTriangles)
{
  InterfaceScene scene(ManyCells(40, 9, 2));
  const InterfaceMesh mesh = Make(scene);
  ExpectSound(mesh);
  int large = 0;
  for (int object = 1; object <= 9; ++object)
  {
    if (VoxelsOf(scene, object) > 1000.)
    {
      ++large;
      EXPECT_NEAR(VolumeOf(mesh, object) / VoxelsOf(scene, object), 1., 2e-3) << object;
    }
  }
  EXPECT_GT(large, 3);
  double sum = 0.;
  double least = 1.;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    const double ratio = RadiusRatio(TriangleOf(mesh, face.Vertex));
    sum += ratio;
    least = IsOffLines(mesh, face) ? std::min(least, ratio) : least;
  }
  EXPECT_GT(sum / static_cast<double>(mesh.Faces.size()), 0.94);
  EXPECT_GT(least, 0.5);
  EXPECT_LT(static_cast<double>(PushWrongVoxels(mesh, *scene.Fields, 0., OnThisThread())),
    0.03 * static_cast<double>(mesh.Position.size()));
}

TEST(MakeInterfaces, HasNoSliversAboutNecks)
{
  // Needles, here and there as thin as a voxel.
  InterfaceScene scene(MakeLabelMap({ 56, 48, 48 }, 1,
    [](int i, int j, int k)
    {
      const int n = j / 12 + 4 * (k / 12);
      const double y = j % 12 - 6. - 0.035 * (n % 4) * (i - 28);
      const double z = k % 12 - 6. - 0.006 * n * (i - 28);
      const double thick = 1. + 0.6 * std::sin(0.35 * i + n);
      return i > 5 && i < 50 && std::hypot(y, z) < thick ? 1 : 0;
    }));
  const InterfaceMesh mesh = Make(scene);
  ExpectSound(mesh);
  double least = 90.;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    const double angle = SmallestAngle(TriangleOf(mesh, face.Vertex));
    least = IsOffLines(mesh, face) ? std::min(least, angle * 57.2958) : least;
  }
  EXPECT_GT(least, 25.);
}

TEST(MakeInterfaces, TurnsNoPartInsideOut)
{
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    SCOPED_TRACE(seed);
    const int objects = 1 + static_cast<int>(seed) % 3;
    InterfaceScene scene(ScatteredVoxels(9, objects, seed));
    const InterfaceMesh mesh = Make(scene);
    ExpectSound(mesh);
    const std::vector<std::vector<int>> faces = mesh.FindFacesOfObjects();
    for (std::size_t object = 1; object < faces.size(); ++object)
    {
      std::vector<int> vertices;
      ExpectTheRightSidesOut(mesh.SurfaceOf(static_cast<int>(object), faces[object], vertices));
    }
  }
}

class StoppedInterfaces : public testing::TestWithParam<int>
{
};

TEST_P(StoppedInterfaces, AreSound)
{
  InterfaceScene scene(ManyCells(28, 6, 4));
  int asked = 0;
  const InterfaceMesh mesh =
    Make(scene, OnThisThread(), [&](double) { return ++asked < GetParam(); });
  ExpectSound(mesh);
  EXPECT_FALSE(mesh.Faces.empty());
}

INSTANTIATE_TEST_SUITE_P(AfterQuestions, StoppedInterfaces, testing::Values(1, 4, 12));

TEST(CorrectVolumes, ShiftsInterfacesToWhatIsMissing)
{
  InterfaceScene scene(FourBlocks(8));
  InterfaceMesh mesh = Make(scene);
  // Object 1 a little smaller: half a percent.
  for (Vector& p : mesh.Position)
  {
    p.X += p.X < 10.f ? 0.04f : 0.f;
  }
  const Vector middle(11.5f, 8.f, 11.5f);
  const float before =
    scene.Fields->ValueAt(1, middle) - scene.Fields->ValueAt(2, middle);
  CorrectVolumes(mesh, *scene.Fields);
  EXPECT_GT(scene.Fields->ValueAt(1, middle) - scene.Fields->ValueAt(2, middle), before);
}
