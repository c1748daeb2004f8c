// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/CheckedFile.h"
#include "EvolutionTestTools.h"
#include "TemporaryFolder.h"

using namespace volumic;

namespace
{
/** Waves, and balls that merge and are lost and found, at three levels; the coarsest comes first.
 */
struct Scene
{
  std::vector<TestVolume> Levels;

  /** @param factor from one unit to the next */
  explicit Scene(double factor = std::sqrt(3.))
  {
    for (int level = 2; level >= 0; --level)
    {
      const double unit = std::pow(factor, level);
      const int n = static_cast<int>(std::lround(40. / unit));
      const double step = 40. / n;
      this->Levels.push_back(MakeVolume(n,
        [step](double x, double y, double z)
        {
          const double a = Distance(step * x, step * y, step * z, 14, 18, 20) - 9.;
          const double b = Distance(step * x, step * y, step * z, 30, 22, 19) - 6.3;
          const double c = Distance(step * x, step * y, step * z, 31, 33, 32) - 2.7;
          const double waves = std::sin(1.1 * step * x) * std::sin(1.3 * step * y + 1.) *
            std::sin(0.9 * step * z + 2.);
          return Soft(std::min(std::min(a, b) + 1.3 * waves, c));
        }));
      this->Levels.back().Image.Step = { step, step, step };
      this->Levels.back().Image.Unit = unit;
    }
  }
};

SurfaceOptions Options()
{
  SurfaceOptions options = IsoHalf();
  options.RecoverCavities = true;
  return options;
}

SurfaceOptions InSmallBlocks()
{
  SurfaceOptions options = Options();
  options.BlockSide = 12.;
  return options;
}

void ExpectSameSurface(const TestEvolution& a, const TestEvolution& b)
{
  const SurfaceResult one = a.Result();
  const SurfaceResult other = b.Result();
  ASSERT_GT(one.Points.size(), 50u);
  EXPECT_TRUE(one.Points == other.Points);
  EXPECT_TRUE(one.Triangles == other.Triangles) << "also where a triangle begins";
  EXPECT_TRUE(one.Normals == other.Normals);
  EXPECT_TRUE(one.Residual == other.Residual);
  EXPECT_TRUE(one.Motionless == other.Motionless);
  EXPECT_EQ(one.Delta, other.Delta);
}

/** A run, and one of another object for each level, by way of a file. */
void ExpectSameByWayOfFiles(const SurfaceOptions& options, const Scene& scene)
{
  const TemporaryFolder folder;
  const std::string name = folder.File("state");
  TestEvolution whole(options, Threads, Silent);
  auto part = std::make_unique<TestEvolution>(options, Threads, Silent);
  for (std::size_t i = 0; i < scene.Levels.size(); ++i)
  {
    SCOPED_TRACE(i);
    const int level = static_cast<int>(scene.Levels.size() - i) - 1;
    for (TestEvolution* evolution : { &whole, part.get() })
    {
      if (i == 0)
      {
        evolution->StartEnclosing(scene.Levels[i].Image, level);
      }
      else
      {
        ASSERT_TRUE(evolution->Divide(scene.Levels[i].Image, level));
      }
    }
    ASSERT_EQ(whole.Run(), part->Run());
    ExpectSameSurface(whole, *part);
    ExpectSameHistory(whole.History(), part->History());
    EXPECT_EQ(whole.Lost().Found, part->Lost().Found);
    EXPECT_EQ(whole.Lost().Missing, part->Lost().Missing);

    part->Leave();
    CheckedWriter file(name);
    part->Rest.Save(file);
    file.Commit();
    part = std::make_unique<TestEvolution>(options, Threads, Silent);
    CheckedReader saved(name);
    part->Rest.Load(saved);
    ExpectSameHistory(whole.History(), part->History());
    // All that was saved is there again.
    CheckedWriter again(folder.File("again"));
    part->Rest.Save(again);
    again.Commit();
    EXPECT_TRUE(BytesOf(name) == BytesOf(folder.File("again")));
  }
}
}

TEST(EvolutionCheckpoint, GoesOnInSweepsAlike)
{
  ExpectSameByWayOfFiles(InSmallBlocks(), Scene());
}

TEST(EvolutionCheckpoint, GoesOnAlikeWhereALevelNeedsNoDivision)
{
  ExpectSameByWayOfFiles(Options(), Scene(1.2));
}

TEST(EvolutionCheckpoint, SavesWhatDoesNotGoOn)
{
  // Nothing is left of the surface; a part that is found at the next level begins a new one.
  const TemporaryFolder folder;
  const Scene scene;
  TestVolume empty = scene.Levels[0];
  empty.Values.assign(empty.Values.size(), 0.f);
  empty.Image.Values = empty.Values.data();
  TestEvolution whole(Options(), Threads, Silent);
  whole.StartEnclosing(empty.Image, 2);
  ASSERT_EQ(whole.Run(), StopReason::Vanished);
  CheckedWriter file(folder.File("state"));
  whole.Leave();
  whole.Rest.Save(file);
  file.Commit();
  TestEvolution part(Options(), Threads, Silent);
  CheckedReader saved(folder.File("state"));
  part.Rest.Load(saved);
  for (TestEvolution* evolution : { &whole, &part })
  {
    ASSERT_TRUE(evolution->Divide(scene.Levels[1].Image, 1));
    evolution->Run();
  }
  ExpectSameSurface(whole, part);
}
