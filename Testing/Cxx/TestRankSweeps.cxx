// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A level whose blocks belong to several ranks: the same bits as on one.
#include "BarTestScene.h"
#include "Core/Common/StandardThreads.h"
#include "EvolutionTestTools.h"
#include "RankTestTools.h"
#include "ThreadRanks.h"

using namespace volumic;

namespace
{
SurfaceOptions ForPlate()
{
  SurfaceOptions options = IsoHalf();
  options.MaximumNumberOfIterations = 40;
  return options;
}

/** What the coarse level has: its factor, and its surface. */
struct Coarse
{
  enum Start
  {
    Enclosing,
    Seed
  };
  Start Begins = Enclosing;
  double Factor = std::sqrt(3.);
  bool Vanishes = false; ///< The fine level shows nothing.
};

struct RunOnRanks
{
  SurfaceResult Surface;
  std::vector<SurfaceResult> Pieces; ///< Of each rank.
  std::vector<HistoryRow> Rows;
  int Missing = 0;
  double MissingBoundary = 0.;
  SurfaceEvolution::LostParts Lost;

  RunOnRanks(int count, SurfaceOptions options, const Coarse& above = Coarse())
  {
    this->Pieces.resize(static_cast<std::size_t>(count));
    const TestVolume coarse = Plate(above.Factor);
    TestVolume fine = Plate(1.);
    if (above.Vanishes)
    {
      std::fill(fine.Values.begin(), fine.Values.end(), 0.f);
    }
    options.MostVoxelsOfRank =
      static_cast<std::int64_t>(coarse.Image.Size[0]) * coarse.Image.Size[1] * coarse.Image.Size[2];
    ThreadRanks::Run(count,
      [&](Communicator& ranks)
      {
        StandardThreads executor(1);
        Monitor monitor;
        SurfaceEvolution evolution(options, executor, monitor);
        if (ranks.Rank() > 0)
        {
          evolution.SetRanks(&ranks);
          evolution.Divide(fine.Image, 0);
          evolution.Run();
          EXPECT_TRUE(evolution.Result().Points.empty());
          this->Pieces[ranks.Rank()] = evolution.PieceOfResult();
          evolution.Unite();
          return;
        }
        switch (above.Begins)
        {
          case Coarse::Seed:
            evolution.StartSeeds(coarse.Image, 1, { { 31., 17., 17. } });
            evolution.Run();
            break;
          case Coarse::Enclosing:
            evolution.StartEnclosing(coarse.Image, 1);
            evolution.Run();
        }
        if (count > 1)
        {
          evolution.SetRanks(&ranks);
        }
        evolution.Divide(fine.Image, 0);
        evolution.Run();
        this->Surface = evolution.Result();
        this->Pieces[0] = evolution.PieceOfResult();
        this->Rows = evolution.History();
        this->Missing = evolution.Lost().Missing;
        this->MissingBoundary = evolution.Lost().MissingBoundary;
        evolution.Unite();
        evolution.SetRanks(nullptr);
        EXPECT_EQ(evolution.Result().Points, this->Surface.Points);
        EXPECT_EQ(evolution.Result().Triangles, this->Surface.Triangles);
        EXPECT_EQ(evolution.Result().Held, this->Surface.Held);
        this->Lost = evolution.Lost();
      });
  }
};

/** Each rank has the piece that is to be cut out of the whole for it. */
void ExpectPiecesOf(const SurfaceResult& whole, const std::vector<SurfaceResult>& pieces)
{
  const int count = static_cast<int>(pieces.size());
  for (int rank = 0; rank < count; ++rank)
  {
    SCOPED_TRACE(rank);
    const SurfaceResult& piece = pieces[rank];
    IndexedSurface surface;
    const PieceOfSurface cut = Cut(whole, rank, count, surface);
    EXPECT_EQ(piece.Points, surface.Points);
    EXPECT_EQ(piece.Triangles, surface.Triangles);
    EXPECT_EQ(piece.Contacts, whole.Contacts);
    EXPECT_EQ(piece.Delta, pieces[0].Delta);
    if (count > 1)
    {
      EXPECT_EQ(piece.Piece.FirstTriangle, cut.FirstTriangle);
      ASSERT_EQ(piece.Piece.Ids, cut.Ids);
      EXPECT_EQ(piece.Piece.Roles, cut.Roles);
    }
    for (std::size_t p = 0; p < cut.Ids.size(); ++p)
    {
      const int id = cut.Ids[p];
      ASSERT_EQ(piece.Normals[p], whole.Normals[id]);
      ASSERT_EQ(piece.Residual[p], whole.Residual[id]);
      ASSERT_EQ(piece.Motionless[p], whole.Motionless[id]);
      ASSERT_EQ(piece.Held[p], whole.Held[id]);
    }
  }
}

void ExpectSame(const RunOnRanks& run, const RunOnRanks& expected)
{
  EXPECT_EQ(run.Surface.Points, expected.Surface.Points);
  EXPECT_EQ(run.Surface.Triangles, expected.Surface.Triangles);
  EXPECT_EQ(run.Surface.Normals, expected.Surface.Normals);
  EXPECT_EQ(run.Surface.Motionless, expected.Surface.Motionless);
  EXPECT_EQ(run.Surface.Held, expected.Surface.Held);
  EXPECT_EQ(run.Surface.Residual, expected.Surface.Residual);
  EXPECT_EQ(run.Surface.Contacts, expected.Surface.Contacts);
  ExpectPiecesOf(expected.Surface, run.Pieces);
  EXPECT_EQ(run.Missing, expected.Missing);
  EXPECT_EQ(run.MissingBoundary, expected.MissingBoundary);
  EXPECT_EQ(run.Lost.Found, expected.Lost.Found);
  EXPECT_EQ(run.Lost.Enclosed, expected.Lost.Enclosed);
  EXPECT_EQ(run.Lost.FoundCavities, expected.Lost.FoundCavities);
  EXPECT_EQ(run.Lost.Missing, expected.Lost.Missing);
  EXPECT_EQ(run.Lost.MissingBoundary, expected.Lost.MissingBoundary);
  ExpectSameHistory(run.Rows, expected.Rows);
}

void ExpectOnRanks(const RunOnRanks& one, const std::vector<int>& counts,
  const SurfaceOptions& options, const Coarse& above = Coarse())
{
  for (const int count : counts)
  {
    SCOPED_TRACE(count);
    ExpectSame(RunOnRanks(count, options, above), one);
  }
}
}

TEST(RankSweeps, SumUpContactsInTheOrderOfOneRank)
{
  // Without merges parts that meet stay in contact: velocities are sums over many close vertices,
  // in the order in which these are found.
  SurfaceOptions options = ForPlate();
  options.TopologyChanges = false;
  const RunOnRanks one(1, options);
  EXPECT_GT(one.Surface.Points.size(), 20000u);
  ExpectOnRanks(one, { 2, 4 }, options);
}

TEST(RankSweeps, MakeTheSurfaceOfOneRank)
{
  const RunOnRanks one(1, ForPlate());
  EXPECT_GT(one.Surface.Points.size(), 20000u);
  SurfaceMesh mesh;
  mesh.Append(one.Surface);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  ExpectOnRanks(one, { 2, 3, 5 }, ForPlate());
}

TEST(RankSweeps, LeavePiecesOfNothing)
{
  SurfaceOptions options = ForPlate();
  options.MaximumNumberOfIterations = 200;
  Coarse above;
  above.Vanishes = true;
  const RunOnRanks one(1, options, above);
  EXPECT_TRUE(one.Surface.Points.empty());
  ExpectOnRanks(one, { 3 }, options, above);
}

TEST(RankSweeps, RecoverWhatOneRankRecovers)
{
  // The coarse level has hardly begun: most of the plate is lost, in the rows of all ranks.
  SurfaceOptions options = ForPlate();
  options.MaximumNumberOfIterations = 5;
  options.RecoverCavities = true;
  const Coarse hardlyBegun{ Coarse::Seed };
  const RunOnRanks one(1, options, hardlyBegun);
  EXPECT_GT(one.Lost.Enclosed, 0);
  EXPECT_GT(one.Surface.Points.size(), 10000u);
  ExpectOnRanks(one, { 2, 4 }, options, hardlyBegun);
}

TEST(RankSweeps, DivideAsOftenAsTheFactorAsks)
{
  // By less than the mesh's factor not at all, by its square twice.
  for (const double factor : { 1.25, 3. })
  {
    SCOPED_TRACE(factor);
    const Coarse above{ Coarse::Enclosing, factor };
    SurfaceOptions options = ForPlate();
    options.MaximumNumberOfIterations = 10;
    const RunOnRanks one(1, options, above);
    EXPECT_GT(one.Surface.Points.size(), 10000u);
    ExpectOnRanks(one, { 3 }, options, above);
  }
}
