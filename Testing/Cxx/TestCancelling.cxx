// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
using Activity = Monitor::Activity;

/** Cancels at the n-th query of an activity and records all queries. */
class StopAt final : public Monitor
{
public:
  StopAt() = default;
  StopAt(int level, Activity activity, int query) : Level(level), Doing(activity), Left(query) {}

  bool GoOn(const Status& status) override
  {
    this->QueriesAfterCancel += this->HasStopped;
    ++this->Queries[{ status.Level, status.Doing }];
    EXPECT_GE(status.Fraction, 0.);
    EXPECT_LE(status.Fraction, 1.);
    this->Fractions.push_back(10. - status.Level + status.Fraction);
    this->HasStopped = this->HasStopped ||
      (status.Level == this->Level && status.Doing == this->Doing && --this->Left == 0);
    return !this->HasStopped;
  }

  std::vector<double> Fractions; ///< total progress: levels and fraction of the level
  std::map<std::pair<int, Activity>, int> Queries;
  bool HasStopped = false;
  int QueriesAfterCancel = 0;

private:
  int Level = -5;
  Activity Doing = Activity::Starting;
  int Left = 0;
};

SurfaceOptions Options()
{
  SurfaceOptions options = IsoHalf();
  options.RecoverCavities = true;
  return options;
}

/** A ball. A second ball and a cavity exist on the fine level only. */
LevelPair Scene()
{
  const auto coarse = [](double x, double y, double z)
  { return Distance(x, y, z, 13, 18, 18) - 10.; };
  const auto fine = [&](double x, double y, double z)
  {
    return std::min(std::max(coarse(x, y, z), 4. - Distance(x, y, z, 13, 18, 18)),
      Distance(x, y, z, 30, 18, 18) - 2.6);
  };
  return LevelPair(36, fine, coarse);
}

/** Run both levels, optionally with an input surface and a tolerance. */
StopReason RunIn(const LevelPair& scene, TestEvolution& evolution, bool isGivenAndGraded)
{
  if (isGivenAndGraded)
  {
    evolution.StartSurface(scene.Coarse.Image, 1, Cuboid({ 2, 6, 6 }, { 24, 30, 30 }));
  }
  else
  {
    evolution.StartEnclosing(scene.Coarse.Image, 1);
  }
  const StopReason reason = evolution.Run();
  evolution.Task.Grading.Tolerance = isGivenAndGraded ? 0.25 : 0.;
  if (reason == StopReason::Cancelled || !evolution.Divide(scene.Fine.Image, 0))
  {
    return reason;
  }
  return evolution.Run();
}
}

class Cancelling : public ::testing::TestWithParam<bool>
{
};

TEST_P(Cancelling, WorksInAllPhasesOfLevel)
{
  const LevelPair scene = Scene();
  StopAt silent;
  TestEvolution evolution(Options(), Threads, silent);
  ASSERT_EQ(RunIn(scene, evolution, GetParam()), StopReason::Converged);
  ASSERT_EQ(evolution.Missed().Enclosed, 1);
  ASSERT_EQ(evolution.Missed().EnclosedCavities, 1);
  EXPECT_TRUE(GetParam() || std::is_sorted(silent.Fractions.begin(), silent.Fractions.end()))
    << "monotonic progress";
  EXPECT_GE((silent.Queries[{ 1, Activity::Starting }]), GetParam() ? 20 : 1);
  EXPECT_GE((silent.Queries[{ 0, Activity::Dividing }]), GetParam() ? 2 : 1);
  EXPECT_GE((silent.Queries[{ 0, Activity::Recovering }]), 7)
    << "objects and cavities, and the end";
  EXPECT_GE((silent.Queries[{ 0, Activity::Iterating }]), 2 * evolution.Iterations() / 5)
    << "a block and the end of the sweep";
  EXPECT_GE((silent.Queries[{ 0, Activity::Regularising }]), 4) << "smoothing and optimization";

  // Cancel at each query, but only at every fifth one of iterations.
  for (const auto& [where, count] : silent.Queries)
  {
    const bool isIterating = where.second == Activity::Iterating;
    for (int query = 1; query <= count; query += isIterating ? 5 : 1)
    {
      SCOPED_TRACE("level " + std::to_string(where.first) + ", activity " +
        std::to_string(static_cast<int>(where.second)) + ", query " + std::to_string(query));
      StopAt monitor(where.first, where.second, query);
      TestEvolution stopped(Options(), Threads, monitor);
      const StopReason reason = RunIn(scene, stopped, GetParam());
      ASSERT_TRUE(monitor.HasStopped);
      EXPECT_TRUE(stopped.IsStopped());
      // At the last query of the coarse level it has converged.
      const bool isBetween =
        where.first == 1 && where.second == Activity::Regularising && query == count;
      EXPECT_EQ(reason, isBetween ? StopReason::Converged : StopReason::Cancelled);
      EXPECT_EQ(monitor.QueriesAfterCancel, 0);
      EXPECT_TRUE(where.second == Activity::Starting || !stopped.Result().Points.empty());
      const SurfaceResult surface = stopped.Result();
      ExpectValidMesh(surface);
      EXPECT_TRUE(!isIterating ||
        stopped.History().back().EulerCharacteristic == MeshOf(surface).CountEulerCharacteristic());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(GivenAndGraded, Cancelling, ::testing::Bool());
