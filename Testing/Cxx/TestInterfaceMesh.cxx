// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceMotion.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "Core/Interfaces/InterfaceStart.h"
#include "Core/Interfaces/JunctionWedges.h"
#include "Core/Interfaces/MismatchedVoxels.h"
#include "Core/Interfaces/TriangleShape.h"
#include "InterfaceTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
/** Four faces around an edge along z, at angles in degrees, between objects 1, 2, 3 and 4. */
InterfaceMesh FacesAt(const std::array<double, 4>& angles)
{
  InterfaceMesh mesh;
  mesh.AddVertex(Vector(0.f, 0.f, 0.f), Stratum::Line);
  mesh.AddVertex(Vector(0.f, 0.f, 1.f), Stratum::Line);
  for (int n = 0; n < 4; ++n)
  {
    const double angle = angles[static_cast<std::size_t>(n)] * std::acos(-1.) / 180.;
    const int outer = mesh.AddVertex(
      Vector(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.5f),
      Stratum::Interface);
    // Object n + 1 is at smaller angles, the next one at larger ones.
    const auto before = static_cast<LabelMap::Number>(n + 1);
    const auto after = static_cast<LabelMap::Number>((n + 1) % 4 + 1);
    mesh.AddFace(before < after ? InterfaceMesh::Face{ { outer, 0, 1 }, before, after }
                                : InterfaceMesh::Face{ { outer, 1, 0 }, after, before });
  }
  return mesh;
}

InterfaceMesh StartOf(const InterfaceScene& scene)
{
  return StartInterfaces(*scene.Fields, OnThisThread());
}

InterfaceMesh RoughMesh(const InterfaceScene& scene)
{
  InterfaceMesh mesh = StartOf(scene);
  InterfaceRemesher remesher(mesh, 1.1, 1.8, 1e-3, OnThisThread(), [] { return true; });
  remesher.CollapseShortEdges();
  remesher.FlipEdges();
  mesh.Compact();
  return mesh;
}

/** Return the mesh after collapses and flips. */
InterfaceMesh Edited(InterfaceMesh mesh, Executor& executor)
{
  InterfaceRemesher remesher(mesh, 1.1, 1.8, 1e-3, executor, [] { return true; });
  EXPECT_GT(remesher.CollapseShortEdges(), 1000);
  EXPECT_GT(remesher.FlipEdges(), 100);
  return mesh;
}

std::uint64_t HashOfMesh(const InterfaceMesh& mesh)
{
  return HashOf(mesh.Faces, HashOf(mesh.Position));
}
}

TEST(JunctionWedges, AreBetweenNeighbouringFaces)
{
  const double degree = std::acos(-1.) / 180.;
  EXPECT_NEAR(NarrowestWedge(FacesAt({ 0., 90., 175., 270. })).Angle, 85. * degree, 1e-6);
  const JunctionWedge across = NarrowestWedge(FacesAt({ 3., 100., 200., 355. }));
  EXPECT_NEAR(across.Angle, 8. * degree, 1e-6);
  EXPECT_EQ(across.Edge, (std::array<int, 2>{ 0, 1 }));
  EXPECT_EQ(across.Faces, (std::array<int, 2>{ 3, 0 }));
  EXPECT_EQ(NarrowestWedge(InterfaceMesh()).Edge[0], -1) << "there are no lines";
}

TEST(InterfaceClearance, DetectsFacesTurnedPastOthers)
{
  const auto areInOrder = [](const std::array<double, 4>& angles, int u, int v)
  {
    const InterfaceMesh mesh = FacesAt(angles);
    std::vector<FaceCoordinates> faces;
    for (const InterfaceMesh::Face& face : mesh.Faces)
    {
      faces.push_back(FaceCoordinatesOf(mesh, face));
    }
    return AreInOrder(u, v, faces);
  };
  EXPECT_TRUE(areInOrder({ 0., 90., 180., 270. }, 0, 1));
  EXPECT_TRUE(areInOrder({ 0., 90., 180., 270. }, 1, 0));
  EXPECT_TRUE(areInOrder({ 300., 20., 30., 299. }, 0, 1));
  EXPECT_FALSE(areInOrder({ 0., 181., 180., 270. }, 0, 1));
  EXPECT_FALSE(areInOrder({ 0., 90., 180., 10. }, 1, 0));
}

TEST(InterfaceClearance, RejectsFacesTurnedPastOthers)
{
  const InterfaceMesh mesh = FacesAt({ 0., 90., 180., 270. });
  InterfaceClearance clearance(mesh, 1e-3);
  clearance.Reset(OnThisThread());
  std::vector<int> near;
  std::vector<FaceCoordinates> made = { FaceCoordinatesOf(mesh, mesh.Faces[1]) };
  EXPECT_TRUE(clearance.AreClear(made, { 1 }, near));
  made.front().Corner[0] = VectorD(-0.9, 0.3, 0.5); // before the face at 180 degrees
  EXPECT_TRUE(clearance.AreClear(made, { 1 }, near));
  made.front().Corner[0] = VectorD(-0.9, -0.3, 0.5); // past it, without an intersection
  EXPECT_FALSE(clearance.AreClear(made, { 1 }, near));
}

TEST(InterfaceClearance, RejectsIntersections)
{
  InterfaceMesh mesh = FacesAt({ 0., 90., 180., 270. });
  const int first = mesh.AddVertex(Vector(0.4f, 0.1f, 0.5f), Stratum::Interface);
  mesh.AddVertex(Vector(0.4f, 0.2f, 0.5f), Stratum::Interface);
  mesh.AddVertex(Vector(0.6f, 0.2f, 0.5f), Stratum::Interface);
  const int beside = mesh.AddFace({ { first, first + 1, first + 2 }, 1, 2 });
  InterfaceClearance clearance(mesh, 1e-3);
  clearance.Reset(OnThisThread());
  std::vector<int> near;
  std::vector<FaceCoordinates> made = { FaceCoordinatesOf(mesh, mesh.Faces[beside]) };
  EXPECT_TRUE(clearance.AreClear(made, { beside }, near));
  made.front().Corner[0] = VectorD(0.4, -0.2, 0.5); // through the face at 0 degrees
  EXPECT_FALSE(clearance.AreClear(made, { beside }, near));
  EXPECT_TRUE(clearance.AreClear(made, { 0, beside }, near)) << "this face is replaced as well";
}

TEST(InterfaceRemesher, IsIndependentOfCubeOrder)
{
  const InterfaceScene scene(ManyCells(64, 60, 2));
  const InterfaceMesh start = StartOf(scene);
  const InterfaceMesh forward = Edited(start, OnThisThread());
  ExpectSound(forward);
  ScrambledExecutor backward(1);
  EXPECT_EQ(HashOfMesh(Edited(start, backward)), HashOfMesh(forward));
  Executor threads(3);
  EXPECT_EQ(HashOfMesh(Edited(start, threads)), HashOfMesh(forward));
}

TEST(InterfaceMotion, RestoresIntersectingFaces)
{
  // Thin plates with steps that are much too large, without limits of edge lengths and angles.
  const InterfaceScene scene(MakeLabelMap({ 20, 20, 20 }, 3,
    [](int i, int j, int k)
    {
      const bool isIn = std::min({ i, j, k }) >= 4 && std::max({ i, j, k }) < 16;
      return isIn ? 1 + k % 3 : 0;
    }));
  InterfaceMesh mesh = RoughMesh(scene);
  ExpectSound(mesh);
  for (int round = 0; round < 4; ++round)
  {
    MoveInterfaces(mesh, *scene.Fields, 4, 1.5, 0., 1e-3, 0., OnThisThread());
    ExpectSound(mesh);
  }
}

TEST(InterfaceMotion, RestoresNarrowTriangles)
{
  constexpr double least = 0.7;
  const InterfaceScene scene(ManyCells(28, 7, 3));
  InterfaceMesh mesh = RoughMesh(scene);
  const LargeVector<Vector> before = mesh.Position;
  MoveInterfaces(mesh, *scene.Fields, 2, 0., 0., 1e-3, least, OnThisThread());
  int narrow = 0;
  for (const InterfaceMesh::Face& face : mesh.Faces)
  {
    MeshTriangle old = TriangleOf(mesh, face.Vertex);
    std::transform(face.Vertex.begin(), face.Vertex.end(), old.Corner,
      [&](int v) { return VectorD(before[static_cast<std::size_t>(v)]); });
    const double angle = SmallestAngle(old);
    EXPECT_GE(SmallestAngle(TriangleOf(mesh, face.Vertex)), std::min(angle, least));
    narrow += angle < least ? 1 : 0;
  }
  EXPECT_GT(narrow, 100);
}

namespace
{
constexpr double Tolerance = 1e-3;

class Edits : public testing::TestWithParam<int>
{
protected:
  void SetUp() override
  {
    this->Scene.emplace(ManyCells(22, 2 + 3 * GetParam(), static_cast<unsigned>(GetParam())));
    this->Mesh = StartOf(*this->Scene);
    ExpectSound(this->Mesh);
    this->Euler = EulerCharacteristicOf(this->Mesh);
  }

  void ExpectSoundAndAlike()
  {
    ExpectSound(this->Mesh);
    EXPECT_EQ(EulerCharacteristicOf(this->Mesh), this->Euler);
  }

  InterfaceRemesher RemesherOf(double shortest, double longest)
  {
    return InterfaceRemesher(
      this->Mesh, shortest, longest, Tolerance, OnThisThread(), [] { return true; });
  }

  std::optional<InterfaceScene> Scene;
  InterfaceMesh Mesh;
  double Euler = 0.;
};
}

TEST_P(Edits, PreserveValidity)
{
  EXPECT_GT(this->RemesherOf(1., 0.8).SplitLongEdges(), 0);
  this->ExpectSoundAndAlike();
  EXPECT_GT(this->RemesherOf(1.1, 1.8).CollapseShortEdges(), 0);
  this->ExpectSoundAndAlike();
  EXPECT_GT(this->RemesherOf(1.1, 1.8).FlipEdges(), 0);
  this->ExpectSoundAndAlike();
  this->RemesherOf(1.1, 1.8).RemoveSlivers();
  this->ExpectSoundAndAlike();
  this->Mesh.Compact();
  this->ExpectSoundAndAlike();
}

TEST_P(Edits, PreserveJunctionsOfVeryCoarseMeshes)
{
  // Collapse until no more collapse is possible.
  for (int round = 0; round < 6; ++round)
  {
    this->RemesherOf(8., 30.).CollapseShortEdges();
  }
  this->ExpectSoundAndAlike();
  EXPECT_FALSE(this->Mesh.FindLines().empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Edits, testing::Range(1, 4));

TEST(MismatchedVoxels, AreFoundInTranslatedMesh)
{
  const LabelMap map = MakeLabelMap(
    { 32, 16, 16 }, 1, [](int i, int j, int k) { return i / 4 == 2 && j / 4 == 1 && k / 4 == 1; });
  const InterfaceScene scene(map);
  const auto countAfter = [&](const Vector& offset, double tolerance, bool isFar)
  {
    InterfaceMesh mesh = StartOf(scene);
    for (Vector& position : mesh.Position)
    {
      position += offset;
    }
    const auto found = FindMismatchedVoxels(
      mesh, map, VoxelBox::Of(map.Size()).Grown(50), map.Spacing, tolerance, OnThisThread());
    return std::count_if(found.begin(), found.end(),
      [&](const MismatchedVoxel& voxel) { return voxel.IsFar == isFar; });
  };
  EXPECT_EQ(countAfter({}, 0., true), 0);
  EXPECT_EQ(countAfter({ 1, 0, 0 }, 0.4, true), 2 * 16);
  EXPECT_EQ(countAfter({ 1, 0, 0 }, 0.6, false), 2 * 16);
  EXPECT_EQ(countAfter({ 8, 0, 0 }, 0., true), 2 * 64) << "also in whole bricks";
  EXPECT_EQ(countAfter({ 40, -40, 40 }, 0., true), 2 * 64) << "and outside the map";
}
