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

/** As vtkDeformableSurface does it. @return how the last level ended. */
StopReason RunIn(const LevelPair& scene, TestEvolution& evolution)
{
  evolution.StartEnclosing(scene.Coarse.Image, 1);
  const StopReason reason = evolution.Run();
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
  EXPECT_FALSE(surface.Points.empty());
  SurfaceMesh mesh;
  mesh.Append(surface);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(CountSelfIntersections(surface), 0);
  const std::vector<HistoryRow>& rows = evolution.History();
  EXPECT_TRUE(!isTold || rows.back().EulerCharacteristic == mesh.CountEulerCharacteristic());
}
}

TEST(Cancelling, IsLookedAtInEveryPartOfALevel)
{
  const LevelPair scene = Scene();
  StopAt silent;
  TestEvolution evolution(Options(), Threads, silent);
  ASSERT_EQ(RunIn(scene, evolution), StopReason::Converged);
  ASSERT_EQ(evolution.Lost().Enclosed, 1);
  ASSERT_EQ(evolution.Lost().EnclosedCavities, 1);
  EXPECT_TRUE(std::is_sorted(silent.Fractions.begin(), silent.Fractions.end()))
    << "progress never goes back";
  const auto questions = [&](int level, Activity doing)
  {
    const auto found = silent.Questions.find({ level, doing });
    return found == silent.Questions.end() ? 0 : found->second;
  };
  EXPECT_GE(questions(1, Activity::Starting), 1);
  EXPECT_GE(questions(0, Activity::Dividing), 1);
  EXPECT_GE(questions(0, Activity::Recovering), 7) << "objects and cavities, and the end";
  EXPECT_GE(questions(0, Activity::Iterating), 2 * evolution.Iterations() / 5)
    << "a visit, and after the sweep";
  EXPECT_GE(questions(0, Activity::Regularising), 4) << "passes and polish";

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
      const StopReason reason = RunIn(scene, stopped);
      ASSERT_TRUE(monitor.HasStopped);
      EXPECT_TRUE(stopped.IsStopped());
      // Before anything of the fine level is done, the coarse one is at rest.
      const bool isBetween =
        where.first == 1 && where.second == Activity::Regularising && question == count;
      EXPECT_EQ(reason, isBetween ? StopReason::Converged : StopReason::Cancelled);
      EXPECT_EQ(monitor.QuestionsAfter, 0);
      ExpectValid(stopped, isIterating);
    }
  }
}
