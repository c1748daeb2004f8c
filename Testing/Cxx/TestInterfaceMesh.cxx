// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/JunctionWedges.h"
#include "InterfaceTestTools.h"

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
