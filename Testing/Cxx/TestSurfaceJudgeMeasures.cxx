// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The second half of TestSurfaceJudge.cxx: what the judge measures.

#include "ForVoxels.h"
#include "SimpleSurfaces.h"
#include "SurfaceJudge.h"
#include "TestPrelude.h"

using namespace volumic::support;

namespace
{

struct Block
{
  std::array<int, 3> Size;
  std::vector<float> Values;

  explicit Block(int n, float value = 0.0f)
    : Size{ n, n, n }, Values(static_cast<std::size_t>(n) * n * n, value)
  {
  }

  float& At(int i, int j, int k)
  {
    return this->Values[(static_cast<std::size_t>(k) * this->Size[1] + j) * this->Size[0] + i];
  }

  void Fill(const std::array<int, 3>& from, const std::array<int, 3>& to, float value)
  {
    volumic::ForBox(from, { to[0] + 1, to[1] + 1, to[2] + 1 },
      [&](int i, int j, int k) { this->At(i, j, k) = value; });
  }

  JudgedVolume Judged(double isoValue, bool bright = true) const
  {
    return { this->Values.data(), this->Size, isoValue, bright };
  }
};

} // namespace

//------------------------------------------------------------------------------
TEST(JudgeLengths, MeasuresEveryEdgeOnce)
{
  const LengthVerdict verdict = JudgeLengths(Sheet(10, 0.0), 0.5);
  EXPECT_EQ(verdict.Edges, 320u); // 220 sides and 100 diagonals
  EXPECT_DOUBLE_EQ(verdict.Shortest, 1.0);
  EXPECT_NEAR(verdict.Longest, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(verdict.Mean, (220.0 + 100.0 * std::sqrt(2.0)) / 320.0, 1e-12);
  EXPECT_EQ(verdict.EdgesTooShort, 0u);
  EXPECT_EQ(verdict.EdgesTooLong, 100u); // over 1.25
  EXPECT_NEAR(verdict.ShareOutside, 100.0 / 320.0, 1e-12);
  EXPECT_EQ(JudgeLengths(Sheet(10, 0.0), 1.001).EdgesTooShort, 220u);
  EXPECT_EQ(JudgeLengths(Sheet(10, 0.0), 1.0).EdgesTooShort, 0u);
}

TEST(JudgeLengths, FindsSheetsTooNear)
{
  TriangleSurface surface = Sheet(10, 0.0);
  Append(surface, Sheet(10, 1.2));
  LengthVerdict verdict = JudgeLengths(surface, 1.0); // bound 1.443
  EXPECT_EQ(verdict.NearPairs, 121u);                 // each vertex with the one above
  EXPECT_NEAR(verdict.NearestPair, 1.2, 1e-12);
  verdict = JudgeLengths(surface, 0.8); // bound 1.155
  EXPECT_EQ(verdict.NearPairs, 0u);
  EXPECT_TRUE(std::isinf(verdict.NearestPair));
}

TEST(JudgeLengths, GoesByTheMeanDeltaOfBothEnds)
{
  const TriangleSurface sheet = Sheet(10, 0.0); // sides of 1, diagonals of 1.41
  std::vector<double> deltas(sheet.Points.size(), 0.6);
  EXPECT_EQ(JudgeLengths(sheet, deltas).ShareOutside, 0.0);
  deltas[60] = 0.4; // the middle of the sheet: its edges may be from 0.5 to 1.25
  LengthVerdict verdict = JudgeLengths(sheet, deltas);
  EXPECT_EQ(verdict.EdgesTooShort, 0u);
  EXPECT_EQ(verdict.EdgesTooLong, 2u);
  deltas[60] = 1.6; // from 1.1
  verdict = JudgeLengths(sheet, deltas);
  EXPECT_EQ(verdict.EdgesTooShort, 4u);
  EXPECT_EQ(verdict.EdgesTooLong, 0u);
  EXPECT_NEAR(verdict.ShareOutside, 4.0 / 320.0, 1e-12);
  deltas.pop_back();
  EXPECT_THROW(JudgeLengths(sheet, deltas), std::invalid_argument);
}

TEST(JudgeLengths, KeepsApartAsFarAsTheSmallerDeltaAsks)
{
  TriangleSurface surface = Sheet(10, 0.0);
  Append(surface, Sheet(10, 1.2));
  // A pair of vertices is too near where both have a delta of 0.9, but not of 0.8.
  std::vector<double> deltas(surface.Points.size(), 0.9);
  EXPECT_EQ(JudgeLengths(surface, deltas).NearPairs, 121u);
  for (const std::size_t fewer : { 60, 121 + 30 }) // one below, one above
  {
    deltas[fewer] = 0.8;
  }
  EXPECT_EQ(JudgeLengths(surface, deltas).NearPairs, 119u);
  deltas[61] = 2.0; // there is nothing more that near to it for which it matters
  EXPECT_EQ(JudgeLengths(surface, deltas).NearPairs, 119u);
}

TEST(JudgeLengths, CountsHopsAlongTheSurface)
{
  // A strip of triangles along x whose far end is bent back over its beginning: vertices 2 k at
  // one side, 2 k + 1 at the other. Places 0, 1, 2, .. hops from the first.
  for (const int hops : { 3, 4 })
  {
    TriangleSurface surface;
    for (int k = 0; k <= hops; ++k)
    {
      const double angle = 5.2 * k / hops;
      surface.Points.push_back({ std::cos(angle), std::sin(angle), 0.0 });
      surface.Points.push_back({ std::cos(angle), std::sin(angle), 5.0 });
      if (k > 0)
      {
        const int a = 2 * k - 2;
        surface.Triangles.push_back({ a, a + 1, a + 2 });
        surface.Triangles.push_back({ a + 1, a + 3, a + 2 });
      }
    }
    // The two ends are 2 sin(0.54) = 1.03 apart; the next smaller distances are over 1.1.
    const LengthVerdict verdict = JudgeLengths(surface, 1.06 * std::sqrt(3.0) / 2.5);
    EXPECT_EQ(verdict.NearPairs, hops == 4 ? 2u : 0u);
  }
}

TEST(JudgeLengths, StaysFastForPointsFarApart)
{
  TriangleSurface surface = Tetrahedron();
  Append(surface, Tetrahedron(1.0, { 1e9, 1e9, -1e9 }));
  EXPECT_EQ(JudgeLengths(surface, 1.0).NearPairs, 0u);
}

//------------------------------------------------------------------------------
TEST(JudgeShapes, MeasuresTheRadiusRatio)
{
  TriangleSurface surface;
  surface.Points = { { 0, 0, 0 }, { 2, 0, 0 }, { 1, std::sqrt(3.0), 0 }, { 0, 2, 0 }, { 4, 0, 0 } };
  surface.Triangles = { { 0, 1, 2 } };
  EXPECT_NEAR(JudgeShapes(surface).Least, 1.0, 1e-12);
  surface.Triangles = { { 0, 1, 3 } };
  EXPECT_NEAR(JudgeShapes(surface).Least, 2.0 * (std::sqrt(2.0) - 1.0), 1e-12);
  surface.Triangles = { { 0, 1, 4 } };
  EXPECT_NEAR(JudgeShapes(surface).Least, 0.0, 1e-12);
}

TEST(JudgeShapes, TakesTheOnePercentQuantile)
{
  TriangleSurface surface;
  surface.Points = { { 0, 0, 0 }, { 2, 0, 0 }, { 1, std::sqrt(3.0), 0 }, { 4, 0, 0 } };
  surface.Triangles.assign(197, { 0, 1, 2 });
  surface.Triangles.insert(surface.Triangles.end(), 3, { 0, 1, 3 });
  ShapeVerdict verdict = JudgeShapes(surface);
  EXPECT_NEAR(verdict.Quantile01, 0.0, 1e-12); // 1.5 % are flat
  EXPECT_NEAR(verdict.Mean, 0.985, 1e-12);
  surface.Triangles.insert(surface.Triangles.end(), 400, { 0, 1, 2 });
  verdict = JudgeShapes(surface); // 0.5 %
  EXPECT_NEAR(verdict.Quantile01, 1.0, 1e-12);
  EXPECT_NEAR(verdict.Least, 0.0, 1e-12);
}

//------------------------------------------------------------------------------
TEST(JudgeIsoDistance, IsRightInARamp)
{
  Block block(12);
  for (int k = 0; k < 12; ++k)
  {
    block.Fill({ 0, 0, k }, { 11, 11, k }, 10.0f * k);
  }
  // The surface lies at z = 4.3, the isopotential at 5.
  const IsoDistanceVerdict verdict = JudgeIsoDistance(Sheet(10, 4.3), block.Judged(50.0));
  EXPECT_NEAR(verdict.MeanAtVertices, 0.7, 1e-9);
  EXPECT_NEAR(verdict.MeanAtCentroids, 0.7, 1e-9);
  EXPECT_NEAR(verdict.LargestAtVertices, 0.7, 1e-9);
  EXPECT_NEAR(JudgeIsoDistance(Sheet(10, 5.0), block.Judged(50.0)).MeanAtVertices, 0.0, 1e-9);
}

TEST(JudgeIsoDistance, DiffersAtVerticesAndCentroids)
{
  Block block(24);
  volumic::ForVoxels({ 24, 24, 24 },
    [&](int i, int j, int k)
    {
      block.At(i, j, k) = static_cast<float>(std::hypot(i - 11.5, j - 11.5, k - 11.5));
    });
  // Corners of a cube on a sphere of radius 8 around the middle: its faces lie far inside.
  const double c = 8.0 / std::sqrt(3.0);
  TriangleSurface surface;
  for (int corner = 0; corner < 8; ++corner)
  {
    surface.Points.push_back(
      { 11.5 + (corner & 1 ? c : -c), 11.5 + (corner & 2 ? c : -c), 11.5 + (corner & 4 ? c : -c) });
  }
  surface.Triangles = { { 0, 1, 3 }, { 4, 5, 7 } };
  const IsoDistanceVerdict verdict = JudgeIsoDistance(surface, block.Judged(8.0));
  EXPECT_NEAR(verdict.MeanAtVertices, 0.0, 0.03);
  EXPECT_NEAR(verdict.MeanAtCentroids, 8.0 - std::hypot(c, c / 3.0, c / 3.0), 0.05);
}

TEST(JudgeIsoDistance, IsBoundedInAFlatField)
{
  const Block block(10, 3.0f);
  EXPECT_EQ(JudgeIsoDistance(Sheet(8, 4.0), block.Judged(5.0), 7.0).MeanAtVertices, 7.0);
  EXPECT_EQ(JudgeIsoDistance(Sheet(8, 4.0), block.Judged(3.0)).MeanAtVertices, 0.0);
}

//------------------------------------------------------------------------------
TEST(JudgeReach, CountsTheShellOfABlock)
{
  Block block(16);
  block.Fill({ 4, 4, 4 }, { 11, 11, 11 }, 1.0f);
  const std::size_t shell = 8 * 8 * 8 - 6 * 6 * 6;
  ReachVerdict verdict = JudgeReach(TriangleSurface(), block.Judged(0.5));
  EXPECT_EQ(verdict.ReachableVoxels, shell);
  EXPECT_EQ(verdict.Share, 0.0);

  // A sheet just under the lower face finds the voxels of that face and those up to 1.5 above.
  TriangleSurface sheet = Sheet(15, 3.5);
  verdict = JudgeReach(sheet, block.Judged(0.5));
  EXPECT_EQ(verdict.FoundVoxels, 64u + 28u);

  // Dark objects alike.
  for (float& value : block.Values)
  {
    value = 1.0f - value;
  }
  verdict = JudgeReach(sheet, block.Judged(0.5, false));
  EXPECT_EQ(verdict.ReachableVoxels, shell);
  EXPECT_EQ(verdict.FoundVoxels, 64u + 28u);
}

TEST(JudgeReach, LeavesOutWhatABallOfAirCannotReach)
{
  // A cube with a cavity, a wide pit that reaches it or not, a crack one voxel wide.
  const auto reachable = [](int pitWidth, int pitDepth)
  {
    Block block(32);
    block.Fill({ 4, 4, 4 }, { 27, 27, 27 }, 1.0f);
    block.Fill({ 10, 10, 12 }, { 20, 20, 20 }, 0.0f);
    block.Fill({ 12, 12, 28 - pitDepth }, { 11 + pitWidth, 11 + pitWidth, 27 }, 0.0f);
    return JudgeReach(TriangleSurface(), block.Judged(0.5)).ReachableVoxels;
  };
  const std::size_t shell = 24 * 24 * 24 - 22 * 22 * 22;
  EXPECT_EQ(reachable(1, 0), shell);
  EXPECT_LE(reachable(1, 7), shell);       // the crack opens the cavity, but the ball doesn't fit
  EXPECT_GT(reachable(1, 7), shell - 10);  // ... and only its mouth is missing
  EXPECT_GT(reachable(5, 7), shell + 500); // now it is a room
}

TEST(JudgeReach, TakesOutsideTheVolumeForAir)
{
  const Block block(8, 1.0f);
  EXPECT_EQ(
    JudgeReach(TriangleSurface(), block.Judged(0.5)).ReachableVoxels, 8u * 8u * 8u - 6u * 6u * 6u);
  EXPECT_EQ(JudgeReach(TriangleSurface(), block.Judged(2.0)).Share, 1.0); // nothing to reach
}

//------------------------------------------------------------------------------
TEST(JudgeSurface, TellsEverythingInWords)
{
  const Block block(16);
  const JudgedVolume volume = block.Judged(0.5);
  const std::string text = Describe(JudgeSurface(Tetrahedron(3.0), 1.0, &volume));
  for (const char* words : { "4 vertices", "closed, manifold, oriented, outward", "genus 0",
         "self-intersecting pairs 0", "radius ratio", "isopotential", "reached" })
  {
    EXPECT_TRUE(volumic::Has(text, words)) << words << " is missing in\n" << text;
  }
}
