// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceRemesher.h"

#include "Core/Interfaces/InterfaceLattice.h"
#include "Core/Interfaces/TriangleShape.h"
#include "InterfaceTestTools.h"

using namespace volumic;

namespace
{
constexpr double Tolerance = 1e-3;

/** Shares of edges that are shorter, and longer, than wanted. */
std::array<double, 2> SharesOutside(const InterfaceMesh& mesh, double shortest, double longest)
{
  const auto edges = FacesAtEdges(mesh);
  double below = 0.;
  double above = 0.;
  for (const auto& edge : edges)
  {
    const float squared =
      SquaredDistance(mesh.Position[static_cast<std::size_t>(edge.first[0])],
        mesh.Position[static_cast<std::size_t>(edge.first[1])]);
    below += squared < shortest * shortest ? 1. : 0.;
    above += squared > longest * longest * 1.0001 ? 1. : 0.;
  }
  const auto all = static_cast<double>(edges.size());
  return { below / all, above / all };
}

class Edits : public testing::TestWithParam<int>
{
protected:
  void SetUp() override
  {
    this->Scene.emplace(ManyCells(22, 2 + 3 * GetParam(), static_cast<unsigned>(GetParam())));
    this->Mesh = InterfaceLattice(*this->Scene->Fields, 1., OnThisThread()).Start(OnThisThread());
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
    return InterfaceRemesher(this->Mesh, shortest, longest, Tolerance, [] { return true; });
  }

  std::optional<InterfaceScene> Scene;
  InterfaceMesh Mesh;
  int Euler = 0;
};
}

TEST_P(Edits, OfEachKindKeepInterfacesSound)
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

TEST_P(Edits, BringEdgesToTheWantedLength)
{
  EXPECT_GT(SharesOutside(this->Mesh, 1.1, 1.8)[0], 0.7);
  for (int round = 0; round < 4; ++round)
  {
    InterfaceRemesher remesher = this->RemesherOf(1.1, 1.8);
    remesher.SplitLongEdges();
    remesher.CollapseShortEdges();
    remesher.FlipEdges();
  }
  const std::array<double, 2> shares = SharesOutside(this->Mesh, 1.1, 1.8);
  EXPECT_LT(shares[0], 0.3);
  EXPECT_LT(shares[1], 0.02);
  this->ExpectSoundAndAlike();
}

TEST_P(Edits, FarTooLargeKeepWhatMeetsWhere)
{
  // Collapses until nothing more may go.
  for (int round = 0; round < 6; ++round)
  {
    this->RemesherOf(8., 30.).CollapseShortEdges();
  }
  this->ExpectSoundAndAlike();
  EXPECT_FALSE(this->Mesh.FindLines().empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, Edits, testing::Range(1, 4));

TEST(RadiusRatio, IsThatOfTheCircles)
{
  const VectorD a(0., 0., 0.);
  const VectorD b(1., 0., 0.);
  EXPECT_NEAR(RadiusRatio(a, b, VectorD(0.5, std::sqrt(0.75), 0.)), 1., 1e-12);
  EXPECT_NEAR(RadiusRatio(a, b, VectorD(0., 1., 0.)), 2. * (std::sqrt(2.) - 1.), 1e-12);
  EXPECT_EQ(RadiusRatio(a, b, VectorD(3., 0., 0.)), 0.);
  EXPECT_EQ(RadiusRatio(a, a, a), 0.);
}
