// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
using Activity = Monitor::Activity;

/** Says stop at the n-th question of an activity, and keeps what it has heard. */
class StopAt final : public Monitor
{
public:
  StopAt() = default;
  StopAt(int level, Activity doing, int question) : Level(level), Doing(doing), Left(question) {}

  bool GoOn(const Status& status) override
  {
    this->QuestionsAfter += this->HasStopped;
    ++this->Questions[{ status.Level, status.Doing }];
    EXPECT_GE(status.Fraction, 0.);
    EXPECT_LE(status.Fraction, 1.);
    this->Fractions.push_back(10. - status.Level + status.Fraction);
    this->HasStopped = this->HasStopped ||
      (status.Level == this->Level && status.Doing == this->Doing && --this->Left == 0);
    return !this->HasStopped;
  }

  std::vector<double> Fractions; ///< Level by level, added to those before.
  std::map<std::pair<int, Activity>, int> Questions;
  bool HasStopped = false;
  int QuestionsAfter = 0;

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

/** A ball; the fine level shows another one and a bubble that the coarse one does not. */
LevelPair Scene()
{
  const auto known = [](double x, double y, double z)
  { return Distance(x, y, z, 13, 18, 18) - 10.; };
  const auto fine = [&](double x, double y, double z)
  {
    return std::min(std::max(known(x, y, z), 4. - Distance(x, y, z, 13, 18, 18)),
      Distance(x, y, z, 30, 18, 18) - 2.6);
  };
  return LevelPair(36, fine, known);
}

/** As vtkDeformableSurface does it, perhaps from a given surface and with a tolerance. @return how
 * the last level ended. */
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

/** @param isTold that the last row tells of it */
void ExpectValid(const TestEvolution& evolution, bool isTold)
{
  const SurfaceResult surface = evolution.Result();
  SurfaceMesh mesh;
  mesh.Append(surface);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(CountSelfIntersections(surface), 0);
  const std::vector<HistoryRow>& rows = evolution.History();
  EXPECT_TRUE(!isTold || rows.back().EulerCharacteristic == mesh.CountEulerCharacteristic());
}
}

class Cancelling : public ::testing::TestWithParam<bool>
{
};

TEST_P(Cancelling, IsLookedAtInEveryPartOfALevel)
{
  const LevelPair scene = Scene();
  StopAt silent;
  TestEvolution evolution(Options(), Threads, silent);
  ASSERT_EQ(RunIn(scene, evolution, GetParam()), StopReason::Converged);
  ASSERT_EQ(evolution.Missed().Enclosed, 1);
  ASSERT_EQ(evolution.Missed().EnclosedCavities, 1);
  EXPECT_TRUE(GetParam() || std::is_sorted(silent.Fractions.begin(), silent.Fractions.end()))
    << "progress never goes back";
  EXPECT_GE((silent.Questions[{ 1, Activity::Starting }]), GetParam() ? 20 : 1);
  EXPECT_GE((silent.Questions[{ 0, Activity::Dividing }]), GetParam() ? 2 : 1);
  EXPECT_GE((silent.Questions[{ 0, Activity::Recovering }]), 7)
    << "objects and cavities, and the end";
  EXPECT_GE((silent.Questions[{ 0, Activity::Iterating }]), 2 * evolution.Iterations() / 5)
    << "a visit, and after the sweep";
  EXPECT_GE((silent.Questions[{ 0, Activity::Regularising }]), 4) << "passes and polish";

  // Now stopped at each of these questions, but only at some of the many after iterations.
  for (const auto& [where, count] : silent.Questions)
  {
    const bool isIterating = where.second == Activity::Iterating;
    for (int question = 1; question <= count; question += isIterating ? 5 : 1)
    {
      SCOPED_TRACE("level " + std::to_string(where.first) + ", activity " +
        std::to_string(static_cast<int>(where.second)) + ", question " + std::to_string(question));
      StopAt monitor(where.first, where.second, question);
      TestEvolution stopped(Options(), Threads, monitor);
      const StopReason reason = RunIn(scene, stopped, GetParam());
      ASSERT_TRUE(monitor.HasStopped);
      EXPECT_TRUE(stopped.IsStopped());
      // Before anything of the fine level is done, the coarse one is at rest.
      const bool isBetween =
        where.first == 1 && where.second == Activity::Regularising && question == count;
      EXPECT_EQ(reason, isBetween ? StopReason::Converged : StopReason::Cancelled);
      EXPECT_EQ(monitor.QuestionsAfter, 0);
      EXPECT_TRUE(where.second == Activity::Starting || !stopped.Result().Points.empty());
      ExpectValid(stopped, isIterating);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(GivenAndGraded, Cancelling, ::testing::Bool());
