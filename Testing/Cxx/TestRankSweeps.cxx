// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A level whose blocks belong to several ranks: the same bits as on one.
#include "BarTestScene.h"
#include "Core/Common/Box.h"
#include "Core/Common/CheckedFile.h"
#include "Core/Common/StandardThreads.h"
#include "EvolutionTestTools.h"
#include "RankTestTools.h"
#include "ThreadRanks.h"

#include <atomic>

using namespace volumic;

namespace
{
SurfaceOptions ForPlate()
{
  SurfaceOptions options = IsoHalf();
  options.MaximumNumberOfIterations = 40;
  return options;
}

/** Two boxes in the place of the plate, which the coarse level joins by a neck: it will be cut. */
TestVolume Boxes(double unit, bool hasNeck)
{
  TestVolume volume = Plate(unit);
  const auto& size = volume.Image.Size;
  const auto box = [](double x, double y, double z, const Box& of)
  {
    return std::max({ of.Low.X - x, x - of.High.X, of.Low.Y - y, y - of.High.Y, of.Low.Z - z,
      z - of.High.Z });
  };
  for (std::size_t i = 0; i < volume.Values.size(); ++i)
  {
    const int n = static_cast<int>(i);
    const double x = unit * (n % size[0]);
    const double y = unit * (n / size[0] % size[1]);
    const double z = unit * (n / size[0] / size[1]);
    double outside = std::min(box(x, y, z, { Vector(8, 8, 8), Vector(36, 104, 50) }),
      box(x, y, z, { Vector(8, 8, 62), Vector(36, 104, 104) }));
    if (hasNeck)
    {
      outside = std::min(outside, box(x, y, z, { Vector(15, 80, 40), Vector(29, 94, 70) }));
    }
    volume.Values[i] = static_cast<float>(Soft(outside / unit));
  }
  return volume;
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
  bool HasNeck = false;
  bool HasOneBetween = false; ///< A level between the two, which the ranks share as well.
  bool IsSaved = false;       ///< After which others go on.
};

/** Another evolution, to which the memory of the rank has brought what rests. */
std::unique_ptr<SurfaceEvolution> Moved(std::unique_ptr<SurfaceEvolution> evolution,
  const std::function<std::unique_ptr<SurfaceEvolution>()>& make)
{
  FileInMemory memory;
  CheckedWriter writer(memory);
  evolution->Save(writer);
  writer.Commit();
  evolution = make();
  CheckedReader reader(memory);
  evolution->Load(reader);
  return evolution;
}

struct RunOnRanks
{
  SurfaceResult Surface;
  std::vector<SurfaceResult> Pieces; ///< Of each rank.
  std::vector<HistoryRow> Rows;
  int Missing = 0;
  double MissingBoundary = 0.;
  SurfaceEvolution::LostParts Lost;
  static constexpr std::size_t OfOthers = 1 << 22;
  std::atomic<unsigned long long> Uniting{ 0 }; ///< Bytes to rank 0.
  SentMessages SentAtLast;                      ///< As the last row has it after that.
  std::vector<HistoryRow> RowsOfLast;           ///< Of the last rank, of the fine level.

  RunOnRanks(int count, SurfaceOptions options, const Coarse& above = Coarse())
  {
    this->Pieces.resize(static_cast<std::size_t>(count));
    const double factor = above.HasOneBetween ? above.Factor * above.Factor : above.Factor;
    const TestVolume coarse = above.HasNeck ? Boxes(factor, true) : Plate(factor);
    const TestVolume between = Plate(above.Factor);
    TestVolume fine = above.HasNeck ? Boxes(1., false) : Plate(1.);
    if (above.Vanishes)
    {
      std::fill(fine.Values.begin(), fine.Values.end(), 0.f);
    }
    options.MostVoxelsOfRank =
      static_cast<std::int64_t>(coarse.Image.Size[0]) * coarse.Image.Size[1] * coarse.Image.Size[2];
    const auto evolve = [&](std::unique_ptr<SurfaceEvolution>& evolution, Communicator& ranks,
                          const std::function<std::unique_ptr<SurfaceEvolution>()>& make)
    {
      if (above.HasOneBetween)
      {
        evolution->Divide(between.Image, 1);
        evolution->Run();
        evolution->LeaveLevel();
        EXPECT_EQ(evolution->IsInPieces(), count > 1);
      }
      if (above.IsSaved)
      {
        evolution = Moved(std::move(evolution), make);
        evolution->SetRanks(count > 1 ? &ranks : nullptr);
      }
      evolution->Divide(fine.Image, 0);
      evolution->Run();
    };
    ThreadRanks::Run(count,
      [&](Communicator& ranks)
      {
        StandardThreads executor(1);
        Monitor monitor;
        const auto make = [&]
        { return std::make_unique<SurfaceEvolution>(options, executor, monitor); };
        std::unique_ptr<SurfaceEvolution> own = make();
        ranks.Broadcast(Message(OfOthers)); // No row has it.
        if (ranks.Rank() > 0)
        {
          own->SetRanks(&ranks);
          evolve(own, ranks, make);
          SurfaceEvolution& evolution = *own;
          EXPECT_TRUE(evolution.Result().Points.empty());
          this->Pieces[ranks.Rank()] = evolution.PieceOfResult();
          const unsigned long long sent = ranks.Sent().Bytes;
          if (ranks.Rank() + 1 == count)
          {
            this->RowsOfLast = evolution.History();
          }
          evolution.Unite();
          this->Uniting += ranks.Sent().Bytes - sent;
          return;
        }
        switch (above.Begins)
        {
          case Coarse::Seed:
            own->StartSeeds(coarse.Image, 2, { { 31., 17., 17. } });
            own->Run();
            break;
          case Coarse::Enclosing:
            own->StartEnclosing(coarse.Image, 2);
            own->Run();
        }
        if (count > 1)
        {
          own->SetRanks(&ranks);
        }
        evolve(own, ranks, make);
        SurfaceEvolution& evolution = *own;
        this->Surface = evolution.Result();
        this->Pieces[0] = evolution.PieceOfResult();
        this->Rows = evolution.History();
        this->Missing = evolution.Lost().Missing;
        this->MissingBoundary = evolution.Lost().MissingBoundary;
        evolution.Unite();
        evolution.SetRanks(nullptr);
        EXPECT_FALSE(evolution.IsInPieces());
        EXPECT_EQ(evolution.Result().Points, this->Surface.Points);
        EXPECT_EQ(evolution.Result().Triangles, this->Surface.Triangles);
        this->SentAtLast = evolution.History().back().Sent;
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
  options.MaximumNumberOfIterations = 20;
  const RunOnRanks one(1, options);
  EXPECT_GT(one.Surface.Points.size(), 20000u);
  EXPECT_GT(one.Surface.Contacts.size(), 200u);
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

TEST(RankSweeps, DivideWhatTheyHaveInPieces)
{
  // Nobody has the whole after the first of two levels that they share.
  Coarse above;
  above.HasOneBetween = true;
  const RunOnRanks one(1, ForPlate(), above);
  EXPECT_GT(one.Surface.Points.size(), 20000u);
  ExpectOnRanks(one, { 2, 3, 5 }, ForPlate(), above);
  above.IsSaved = true;
  ExpectOnRanks(one, { 1, 3 }, ForPlate(), above);
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

TEST(RankSweeps, TellHowMuchTheySend)
{
  const RunOnRanks one(1, ForPlate());
  const RunOnRanks two(2, ForPlate());
  double least = 1e9; // Of messages in a sweep.
  double sweep = 0.;
  for (const HistoryRow& row : two.Rows)
  {
    EXPECT_EQ(row.Sent.Bytes > 0., row.Level == 0);
    const bool endsSweep = row.Iteration % 5 == 0; // All of them have five.
    sweep += row.Sent.Messages;
    least = endsSweep && row.Level == 0 ? std::min(least, sweep) : least;
    sweep = endsSweep ? 0. : sweep;
  }
  // To the other one: 8 exchanges, and 8 sums and lists.
  EXPECT_NEAR(least, 16., 1e-9);
  const auto begin = std::find_if(
    two.Rows.begin(), two.Rows.end(), [](const HistoryRow& row) { return row.Level == 0; });
  ASSERT_LT(begin, two.Rows.end() - 10);
  EXPECT_GT(begin->Sent.Bytes, 2. * begin[1].Sent.Bytes) << "the division";
  EXPECT_LT(begin->Sent.Bytes, 1. * RunOnRanks::OfOthers);
  ASSERT_EQ(two.RowsOfLast.size(), static_cast<std::size_t>(two.Rows.end() - begin));
  for (std::size_t i = 0; i < two.RowsOfLast.size(); ++i)
  {
    EXPECT_EQ(two.RowsOfLast[i].Sent.Bytes, begin[static_cast<std::ptrdiff_t>(i)].Sent.Bytes)
      << "the most of all, " << i;
  }
  EXPECT_EQ(begin[1].Sent.Bytes, begin[4].Sent.Bytes) << "in equal parts";
  // The regularisation, then half of a mesh without all that its vertices know.
  EXPECT_GT(two.Rows.back().Sent.Bytes, two.Rows[two.Rows.size() - 2].Sent.Bytes);
  EXPECT_LT(two.Uniting, 60 * two.Surface.Points.size() / 2);
  EXPECT_GE(two.SentAtLast.Bytes, two.Rows.back().Sent.Bytes + static_cast<double>(two.Uniting));
  for (const HistoryRow& row : one.Rows)
  {
    EXPECT_EQ(row.Sent.Messages, 0.);
  }
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

TEST(RankSweeps, CutOnOneRankAlone)
{
  // All of them must look then for what is inside out.
  SurfaceOptions options = ForPlate();
  options.MaximumNumberOfIterations = 60;
  Coarse withNeck;
  withNeck.HasNeck = true;
  const RunOnRanks one(1, options, withNeck);
  const auto cut = std::find_if(one.Rows.begin(), one.Rows.end(),
    [](const HistoryRow& row) { return row.Level == 0 && row.Cuts > 0; });
  ASSERT_NE(cut, one.Rows.end());
  EXPECT_GT(cut[0].Iteration - one.Rows.front().Iteration, 10) << "not looked for anyhow";
  EXPECT_EQ(one.Rows.back().Components, 2);
  ExpectOnRanks(one, { 3 }, options, withNeck);
}

TEST(RankSweeps, DivideWhatTheyHaveInPiecesTwice)
{
  SurfaceOptions options = ForPlate();
  options.MaximumNumberOfIterations = 15;
  Coarse above{ Coarse::Enclosing, 3. };
  above.HasOneBetween = true;
  const RunOnRanks one(1, options, above);
  EXPECT_GT(one.Surface.Points.size(), 10000u);
  ExpectOnRanks(one, { 2, 4 }, options, above);
}

TEST(RankSweeps, DivideAsOftenAsTheFactorAsks)
{
  // By less than the mesh's factor not at all, by its square twice, and so on.
  for (const double factor : { 1.25, 3., 5.2 })
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
