// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// No state of the surface ever intersects itself: looked at during the evolution, not only after
// it.
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/PyramidGeometry.h"
#include "SurfaceJudge.h"
#include "SyntheticScenes.h"
#include "TestPrelude.h"

using namespace volumic;
using namespace volumic::support;

namespace
{
/** The levels of a scene, finest first. */
struct Levels
{
  std::vector<LevelGeometry> Geometry;
  std::vector<std::vector<float>> Values;

  explicit Levels(const Scene& scene)
    : Geometry(PlanPyramid({ scene.Size[0], scene.Size[1], scene.Size[2] }, scene.Spacing, {}))
  {
    SequentialExecutor executor;
    this->Values.push_back(scene.Values);
    for (std::size_t h = 1; h < this->Geometry.size(); ++h)
    {
      std::vector<float> next(this->Geometry[h].NumberOfVoxels());
      ReduceLevel(this->Values[h - 1].data(), this->Geometry[h - 1], next.data(), this->Geometry[h],
        executor, [](double) { return true; });
      this->Values.push_back(std::move(next));
    }
  }

  LevelImage Image(int h) const
  {
    LevelImage image;
    image.Values = this->Values[h].data();
    for (int axis = 0; axis < 3; ++axis)
    {
      image.Size[axis] = static_cast<int>(this->Geometry[h].Size[axis]);
      image.Step[axis] =
        static_cast<double>(this->Geometry[0].Size[axis]) / this->Geometry[h].Size[axis];
    }
    image.Unit = this->Geometry[h].Unit / this->Geometry[0].Unit;
    return image;
  }
};

/** Judges the surface after every tenth iteration. */
class Witness final : public Monitor
{
public:
  const SurfaceEvolution* Evolution = nullptr;
  int Looks = 0;

  bool Continue(const Status& status) override
  {
    if (status.Iteration % 10 == 0)
    {
      const SurfaceResult surface = this->Evolution->Result();
      TriangleSurface judged;
      judged.Points.assign(surface.Points.begin(), surface.Points.end());
      judged.Triangles.assign(surface.Triangles.begin(), surface.Triangles.end());
      const std::string where =
        "level " + std::to_string(status.Level) + ", iteration " + std::to_string(status.Iteration);
      const TopologyVerdict topology = JudgeTopology(judged);
      EXPECT_TRUE(topology.Closed && topology.Manifold && topology.Oriented) << where;
      EXPECT_EQ(JudgeIntersections(judged).Pairs, 0u) << where;
      // Eq. (1), but for edges whose split would make a needle: these get no longer (HugeEdge).
      const LengthVerdict lengths = JudgeLengths(judged, surface.Delta);
      EXPECT_LE(lengths.Longest, 1.4 * 2.5 * surface.Delta) << where;
      EXPECT_LE(lengths.EdgesTooLong, 3u) << where;
      ++this->Looks;
    }
    return !::testing::Test::HasFailure();
  }
};

int EvolveUnderWatch(const Scene& scene, int coarsest, const SurfaceOptions& given)
{
  const Levels levels(scene);
  SurfaceOptions options = given;
  options.IsoValue = scene.IsoValue;
  options.ObjectIsBright = scene.ObjectIsBright;
  SequentialExecutor executor;
  Witness witness;
  SurfaceEvolution evolution(options, executor, witness);
  witness.Evolution = &evolution;
  for (int h = coarsest; h >= 0; --h)
  {
    if (h == coarsest)
    {
      evolution.StartEnclosing(levels.Image(h), h);
    }
    else
    {
      evolution.Divide(levels.Image(h), h);
    }
    evolution.Run();
  }
  return witness.Looks;
}
}

class SurfaceEveryTenthIteration : public ::testing::TestWithParam<SceneKind>
{
};

TEST_P(SurfaceEveryTenthIteration, IsValidWithPyramid)
{
  const Scene scene = MakeScene(GetParam());
  EXPECT_GT(EvolveUnderWatch(scene, scene.CoarsestFaithfulLevel, {}), 2);
}

TEST_P(SurfaceEveryTenthIteration, IsValidWithoutPyramidInNoise)
{
  SceneOptions options;
  options.NoiseShare = 0.2;
  options.NoiseSeed = 3; // as in TestSurfaceScenes.cxx
  EXPECT_GT(EvolveUnderWatch(MakeScene(GetParam(), options), 0, {}), 5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SurfaceEveryTenthIteration,
  ::testing::Values(SceneKind::Torus, SceneKind::NestedBalls, SceneKind::ThinShellWithEightHoles),
  [](const ::testing::TestParamInfo<SceneKind>& instance) { return SceneName(instance.param); });
