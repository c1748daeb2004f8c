// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"
#include "InterfaceTestTools.h"

using namespace volumic;

namespace
{
/** Two tetrahedra, objects 1 and 2, that have a face in common. */
InterfaceMesh TwoTetrahedra()
{
  InterfaceMesh mesh;
  mesh.AddVertex(Vector(0.f, 0.f, 0.f), Stratum::Interface);
  mesh.AddVertex(Vector(1.f, 0.f, 0.f), Stratum::Interface);
  mesh.AddVertex(Vector(0.f, 1.f, 0.f), Stratum::Interface);
  mesh.AddVertex(Vector(0.3f, 0.3f, -1.f), Stratum::Interface); // object 1 is below
  mesh.AddVertex(Vector(0.3f, 0.3f, 1.f), Stratum::Interface);
  mesh.AddFace({ { 0, 1, 2 }, 1, 2 });
  const std::array<std::array<int, 2>, 3> edges = { { { 0, 1 }, { 1, 2 }, { 2, 0 } } };
  for (const std::array<int, 2>& edge : edges)
  {
    mesh.AddFace({ { edge[0], edge[1], 3 }, 0, 1 });
    mesh.AddFace({ { edge[1], edge[0], 4 }, 0, 2 });
  }
  mesh.FindStrata();
  return mesh;
}
}

TEST(InterfaceMesh, KnowsWhatMeetsAtAVertex)
{
  const InterfaceMesh mesh = TwoTetrahedra();
  std::vector<int> found;
  mesh.FindFaces(0, 1, found);
  EXPECT_EQ(found.size(), 3u);
  mesh.FindNeighbours(3, found);
  EXPECT_EQ(found, (std::vector<int>{ 0, 0, 1, 1, 2, 2 }));
  mesh.FindObjects(0, found);
  EXPECT_EQ(found, (std::vector<int>{ 0, 1, 2 }));
  mesh.FindObjects(4, found);
  EXPECT_EQ(found, (std::vector<int>{ 0, 2 }));
  EXPECT_TRUE(mesh.HasEdge(0, 4));
  EXPECT_FALSE(mesh.HasEdge(3, 4));
}

TEST(InterfaceMesh, LiesInFilesWhereMemoryIsLimited)
{
  ScratchOptions options;
  options.Limit = std::size_t(8) << 30;
  const ScratchMemory scratch(options);
  InterfaceMesh mesh;
  const int count = 1 << 18;
  for (int v = 0; v < count; ++v)
  {
    mesh.AddVertex(Vector(static_cast<float>(v), 0.f, 0.f), Stratum::Interface);
    if (v >= 2)
    {
      mesh.AddFace({ { v - 2, v - 1, v }, 0, 1 });
    }
  }
  mesh.Compact();
  // Places, faces, and of both what has which corner.
  const std::size_t ofVertex = sizeof(Vector) + sizeof(int);
  const std::size_t ofFace = sizeof(InterfaceMesh::Face) + 3 * sizeof(int);
  EXPECT_GE(scratch.Statistics().Mapped, (count - 2) * (ofVertex + ofFace));
}

TEST(InterfaceMesh, HasLinesWhereThreeFacesMeet)
{
  const InterfaceMesh mesh = TwoTetrahedra();
  EXPECT_EQ(mesh.FindLines(),
    (std::vector<std::array<int, 2>>{ { 0, 1 }, { 0, 2 }, { 1, 2 } }));
  EXPECT_EQ(mesh.StratumOf[0], Stratum::Line);
  EXPECT_EQ(mesh.StratumOf[3], Stratum::Interface);
  ExpectSound(mesh);
}

TEST(InterfaceMesh, CompactsWhatIsRemoved)
{
  InterfaceMesh mesh = TwoTetrahedra();
  const int added = mesh.AddVertex(Vector(0.3f, 0.3f, -2.f), Stratum::Interface);
  std::vector<int> faces;
  mesh.ForFaces(3, [&](int face) { faces.push_back(face); });
  for (const int face : faces)
  {
    mesh.ReplaceVertex(face, 3, added);
  }
  EXPECT_FALSE(mesh.IsVertex(3));
  EXPECT_TRUE(mesh.IsVertex(added));
  mesh.Compact();
  EXPECT_EQ(mesh.Position.size(), 5u);
  ExpectSound(mesh);
  EXPECT_NEAR(VolumeOf(mesh, 1), 2. / 6., 1e-6);
  mesh.RemoveFace(0);
  mesh.Compact();
  EXPECT_EQ(mesh.Faces.size(), 6u);
}
