// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/MakeInterfaces.h"

#include "Core/Interfaces/InterfaceFit.h"
#include "Core/Interfaces/InterfaceSizes.h"
#include "Core/Interfaces/JunctionWedges.h"
#include "Core/Interfaces/TriangleShape.h"
#include "Core/Mesh/TriangleDistance.h"
#include "InterfaceTestTools.h"
#include "SurfaceTopology.h"

using namespace volumic;

namespace
{
bool IsOffLines(const InterfaceMesh& mesh, const InterfaceMesh::Face& face)
{
  return std::all_of(face.Vertex.begin(), face.Vertex.end(),
    [&](int v) { return mesh.StratumOf[static_cast<std::size_t>(v)] == Stratum::Interface; });
}

InterfaceMesh Make(
  InterfaceScene& scene, double tolerance = 0.,
  const std::function<bool(double)>& progress = [](double) { return true; })
{
  InterfaceOptions options;
  options.Tolerance = tolerance;
  return MakeInterfaces(*scene.Fields, options, OnThisThread(), progress);
}

/** Three overlapping balls. */
LabelMap ThreeBalls()
{
  return MakeLabelMap({ 40, 32, 40 }, 3,
    [](int i, int j, int k)
    {
      return std::hypot(i - 12., j - 15., k - 29.) < 7.9 ? 3
        : std::hypot(i - 21., j - 12., k - 22.) < 6.1    ? 2
        : std::hypot(i - 11., j - 16., k - 14.) < 7.2    ? 1
                                                         : 0;
    });
}

/** Return the least angle in degrees, of all triangles or of those off the junction lines. */
double LeastAngle(const InterfaceMesh& mesh, bool isOfAll)
{
  double least = 90.;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    const double angle = SmallestAngle(TriangleOf(mesh, face.Vertex)) * 57.2958;
    least = isOfAll || IsOffLines(mesh, face) ? std::min(least, angle) : least;
  }
  return least;
}

double VoxelsOf(const InterfaceScene& scene, int object)
{
  return static_cast<double>(scene.Bricks->ExtentOf(object).Voxels);
}

float LargestSize(const InterfaceMesh& mesh)
{
  return *std::max_element(mesh.Size.begin(), mesh.Size.end());
}

/** Return the maximum growth of sizes per length between any two vertices. */
double SteepestSize(const InterfaceMesh& mesh)
{
  double steepest = 0.;
  for (std::size_t v = 0; v < mesh.Size.size(); ++v)
  {
    for (std::size_t w = 0; w < v; ++w)
    {
      const double distance = Length(mesh.Position[v] - mesh.Position[w]);
      steepest = std::max(steepest, std::abs(mesh.Size[v] - mesh.Size[w]) / distance);
    }
  }
  return steepest;
}
}

TEST(MakeInterfaces, PreservesVolumesWithGoodTriangles)
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
  double sum = 0., least = 1.;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    const double ratio = RadiusRatio(TriangleOf(mesh, face.Vertex));
    sum += ratio;
    least = IsOffLines(mesh, face) ? std::min(least, ratio) : least;
  }
  EXPECT_GT(sum / static_cast<double>(mesh.Faces.size()), 0.94);
  EXPECT_GT(least, 0.5);
  EXPECT_LT(static_cast<double>(PushMisclassifiedVoxels(mesh, *scene.Fields, 0., OnThisThread())),
    0.03 * static_cast<double>(mesh.Position.size()));
}

TEST(MakeInterfaces, HasNoSliversAtNecks)
{
  // Needles with necks of about one voxel.
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
  EXPECT_GT(LeastAngle(mesh, false), 25.);
}

TEST(MakeInterfaces, HasNoNarrowWedges)
{
  InterfaceScene scene(ThreeBalls());
  const InterfaceMesh mesh = Make(scene);
  ExpectSound(mesh);
  EXPECT_GT(NarrowestWedge(mesh).Angle * 57.2958, 10.);
  EXPECT_GT(LeastAngle(mesh, true), 20.);
}

TEST(MakeInterfaces, HasNoNarrowGaps)
{
  for (unsigned seed = 6; seed < 18; ++seed)
  {
    SCOPED_TRACE(seed);
    InterfaceScene scene(seed < 12 ? ScatteredVoxels(9, 3, seed) : ManyCells(24, 6, seed));
    const InterfaceMesh mesh = Make(scene);
    ExpectSound(mesh);
    double least = 9.;
    for (std::size_t f = 0; f < mesh.Faces.size(); ++f)
    {
      const MeshTriangle face = TriangleOf(mesh, mesh.Faces[f].Vertex);
      for (std::size_t g = 0; g < f; ++g)
      {
        least = std::min(least, SquaredGapBetween(face, TriangleOf(mesh, mesh.Faces[g].Vertex)));
      }
    }
    EXPECT_GT(std::sqrt(least), 0.12); // 0.09 edge lengths
  }
}

TEST(MakeInterfaces, InvertsNoPartsWithAndWithoutTolerance)
{
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    SCOPED_TRACE(seed);
    const int objects = 1 + static_cast<int>(seed) % 3;
    InterfaceScene scene(ScatteredVoxels(9, objects, seed));
    const InterfaceMesh mesh = Make(scene, 0.1 * (seed % 4));
    ExpectSound(mesh);
    for (const auto& [object, surface] : SurfacesOf(mesh))
    {
      EXPECT_TRUE(object == 0 || surface.Negative == 0) << object << " has no cavities";
    }
  }
}

/** Parameters: voxel spacing (3), tolerance, and 1 if the box is periodic. */
class InterfacesInBox : public testing::TestWithParam<std::array<double, 5>>
{
};

TEST_P(InterfacesInBox, AreFlatAtBoxSides)
{
  const std::array<double, 3> spacing = { GetParam()[0], GetParam()[1], GetParam()[2] };
  const bool isPeriodic = GetParam()[4] != 0.;
  InterfaceScene scene(
    Grains({ 40, 36, 37 }, spacing, 14, 3), { { 8, 8, 8 }, { 32, 29, 28 } }, isPeriodic);
  const InterfaceMesh mesh = Make(scene, GetParam()[3]);
  ExpectSound(mesh);
  for (const int faces : ExpectFlatSides(mesh, *scene.Fields))
  {
    EXPECT_GT(faces, 20);
  }
  if (isPeriodic)
  {
    ExpectMatchingSides(mesh);
  }
  const double ofVoxel = spacing[0] * spacing[1] * spacing[2];
  double all = 0.;
  for (int object = 1; object <= 14; ++object)
  {
    const double voxels = VoxelsOf(scene, object);
    const double volume = voxels > 0. ? VolumeOf(mesh, object) / ofVoxel : 0.;
    EXPECT_NEAR(volume, voxels, std::max(15., 0.01 * voxels)) << object;
    all += volume;
  }
  EXPECT_NEAR(all, 24. * 21. * 20., 1e-3); // the whole box
  // The edges of the box are lines; its corners are vertices on three sides.
  int corners = 0;
  double edges = 0.;
  std::vector<int> about;
  const auto sidesAt = [&](int v)
  {
    mesh.FindObjects(v, about);
    return std::count_if(about.begin(), about.end(), [&](int o) { return mesh.IsSide(o); });
  };
  for (int v = 0; v < static_cast<int>(mesh.Position.size()); ++v)
  {
    corners += sidesAt(v) == 3 ? 1 : 0;
  }
  for (const std::array<int, 2>& line : mesh.FindLines())
  {
    mesh.FindFaces(line[0], line[1], about);
    const auto isOther = [&](int f) { return mesh.Faces[f].Front != mesh.Faces[about[0]].Front; };
    const bool isEdge = about.size() == 2 && std::any_of(about.begin(), about.end(), isOther);
    edges += isEdge ? Length(mesh.Position[line[0]] - mesh.Position[line[1]]) : 0.;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_NEAR(edges, 4. * (24. * spacing[0] + 21. * spacing[1] + 20. * spacing[2]), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(OfVoxels, InterfacesInBox,
  testing::Values(std::array<double, 5>{ 1., 1., 1., 0., 0. },
    std::array<double, 5>{ 1., 1., 1., 0.3, 0. }, std::array<double, 5>{ 1., 1., 2.5, 0., 0. },
    std::array<double, 5>{ 1., 1., 1., 0., 1. }, std::array<double, 5>{ 1., 1., 1.7, 0.3, 1. }));

TEST(MakeInterfaces, EndAtBoxInNoise)
{
  for (unsigned seed = 0; seed < 6; ++seed)
  {
    SCOPED_TRACE(seed);
    const LabelMap noise = NoisyLabelMap({ 16, 16, 16 }, 1 + static_cast<int>(seed) % 3, seed);
    for (const bool isPeriodic : { false, true })
    {
      InterfaceScene scene(noise, { { 4, 4, 4 }, { 12, 11, 9 } }, isPeriodic);
      const InterfaceMesh mesh = Make(scene);
      ExpectSound(mesh);
      ExpectFlatSides(mesh, *scene.Fields);
      if (isPeriodic)
      {
        ExpectMatchingSides(mesh);
      }
    }
  }
}

TEST(MakeInterfaces, IsValidIfCancelled)
{
  for (const int last : { 1, 12, 40, 90 })
  {
    SCOPED_TRACE(last);
    InterfaceScene scene(ManyCells(28, 6, 4));
    int calls = 0;
    const InterfaceMesh mesh = Make(scene, 0., [&](double) { return ++calls < last; });
    ExpectSound(mesh);
    EXPECT_EQ(mesh.Faces.empty(), last == 1) << "empty only if cancelled by the first call";
  }
}

TEST(InterfaceSizes, GrowAtFlatInterfacesWithinGradation)
{
  InterfaceScene scene(InBackground(2 * 10 + 2 * LabelBricks::Side, 4,
    [](int i, int j, int)
    { return 1 + (i >= 10 + LabelBricks::Side) + 2 * (j >= 10 + LabelBricks::Side); }));
  InterfaceMesh mesh = Make(scene);
  EXPECT_EQ(LargestSize(mesh), 1.f);
  const SizeBounds bounds = { 0.1, 2.5, 1.8, 0.2 };
  InterfaceMesh off = mesh;
  for (Vector& p : off.Position)
  {
    p += Vector(0.2f, 0.2f, 0.2f); // A translation is not an error, as for straightened lines.
  }
  AdjustSizes(off, *scene.Fields, bounds, OnThisThread());
  EXPECT_EQ(LargestSize(off), 1.8f);
  AdjustSizes(mesh, *scene.Fields, bounds, OnThisThread());
  EXPECT_LT(SteepestSize(mesh), 1.001 * bounds.Gradation);
  EXPECT_EQ(LargestSize(mesh), 1.8f);
  EXPECT_EQ(*std::min_element(mesh.Size.begin(), mesh.Size.end()), 1.f); // at the edges of the cube
}
