// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The scenes hold what they promise: judged on a marching surface of the sampled values.

#include "ForVoxels.h"
#include "SupportVtkConversions.h"
#include "TestPrelude.h"

#include <vtkFlyingEdges3D.h>
#include <vtkImageConstantPad.h>

using namespace volumic::support;

namespace
{

/** Of the scene in a border of background, which closes what coarse levels spread up to the border.
 */
TopologyVerdict JudgeMarchingSurface(const Scene& scene)
{
  vtkNew<vtkImageConstantPad> border;
  border->SetInputData(ToImage(scene));
  border->SetConstant(scene.Values[0]);
  border->SetOutputWholeExtent(-1, scene.Size[0], -1, scene.Size[1], -1, scene.Size[2]);
  vtkNew<vtkFlyingEdges3D> marching;
  marching->SetInputConnection(border->GetOutputPort());
  marching->SetValue(0, scene.IsoValue);
  marching->Update();
  return JudgeTopology(ToTriangleSurface(marching->GetOutput()));
}

void ExpectPromisedTopology(const Scene& scene)
{
  const TopologyVerdict verdict = JudgeMarchingSurface(scene);
  EXPECT_TRUE(verdict.Closed);
  EXPECT_EQ(static_cast<int>(verdict.Components.size()), scene.Components);
  EXPECT_EQ(verdict.Genus, scene.Genus);
}

std::size_t VoxelAt(const Scene& scene, int i, int j, int k)
{
  return (static_cast<std::size_t>(k) * scene.Size[1] + j) * scene.Size[0] + i;
}

/** Air that no path of 6-neighbours joins to the border becomes object. */
void FillCavities(Scene& scene)
{
  std::vector<char> reached(scene.Values.size(), 0);
  std::vector<std::array<int, 3>> stack = { { 0, 0, 0 } };
  reached[0] = 1;
  while (!stack.empty())
  {
    const std::array<int, 3> at = stack.back();
    stack.pop_back();
    for (int side = 0; side < 6; ++side)
    {
      std::array<int, 3> next = at;
      const int axis = side / 2;
      next[axis] += side % 2 ? 1 : -1;
      if (next[axis] < 0 || next[axis] >= scene.Size[axis])
      {
        continue;
      }
      const std::size_t voxel = VoxelAt(scene, next[0], next[1], next[2]);
      if (!scene.Inside[voxel] && !reached[voxel])
      {
        reached[voxel] = 1;
        stack.push_back(next);
      }
    }
  }
  const float full = *std::max_element(scene.Values.begin(), scene.Values.end());
  for (std::size_t voxel = 0; voxel < reached.size(); ++voxel)
  {
    if (!reached[voxel])
    {
      scene.Values[voxel] = full;
    }
  }
}

/** One axis of a level of the pyramid made by its definition, without any cleverness: kernel and
    interpolation of eq. 5 with T = sqrt 3. `unit` is U_h, in voxels of level 0. */
void ReduceAxis(Scene& level, int axis, double unit, int fullSize)
{
  const std::array<int, 3> size = level.Size;
  std::array<int, 3> reduced = size;
  reduced[axis] = static_cast<int>(size[axis] / std::sqrt(3.0));
  std::vector<float> values;
  volumic::ForVoxels(reduced,
    [&](int i, int j, int k)
    {
      std::array<int, 3> at = { i, j, k };
      const double place = static_cast<double>(at[axis]) * size[axis] / reduced[axis];
      const double weights[] = { 1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16 };
      double sum = 0.0;
      for (int m = -2; m <= 2; ++m)
      {
        const double x =
          std::clamp(place + m * unit * size[axis] / fullSize, 0.0, size[axis] - 1.0);
        const int low = std::min(static_cast<int>(x), size[axis] - 2);
        for (int side = 0; side < 2; ++side)
        {
          at[axis] = low + side;
          sum += weights[m + 2] * (side ? x - low : 1.0 - x + low) *
            level.Values[VoxelAt(level, at[0], at[1], at[2])];
        }
      }
      values.push_back(static_cast<float>(sum));
    });
  level.Size = reduced;
  level.Values = values;
}

class SyntheticScenes : public ::testing::TestWithParam<SceneKind>
{
};

} // namespace

TEST_P(SyntheticScenes, HaveThePromisedTopology)
{
  const Scene scene = MakeScene(GetParam());
  if (scene.OneIsoValueFits)
  {
    ExpectPromisedTopology(scene);
  }
  else
  {
    // The bright end of the background joins in.
    EXPECT_GT(JudgeMarchingSurface(scene).Components.size(), 1u);
  }
}

TEST_P(SyntheticScenes, KeepItWhenDark)
{
  SceneOptions options;
  options.ObjectIsBright = false;
  const Scene scene = MakeScene(GetParam(), options);
  EXPECT_FALSE(scene.ObjectIsBright);
  if (scene.OneIsoValueFits)
  {
    ExpectPromisedTopology(scene);
  }
}

TEST_P(SyntheticScenes, KeepItAtOtherSizes)
{
  for (const std::array<int, 3>& size :
    { std::array<int, 3>{ 48, 48, 48 }, std::array<int, 3>{ 90, 104, 96 } })
  {
    SceneOptions options;
    options.Size = size;
    const Scene scene = MakeScene(GetParam(), options);
    ASSERT_EQ(scene.Values.size(), static_cast<std::size_t>(size[0]) * size[1] * size[2]);
    if (scene.OneIsoValueFits)
    {
      ExpectPromisedTopology(scene);
    }
  }
}

TEST_P(SyntheticScenes, KeepItWithAnisotropicVoxels)
{
  SceneOptions options;
  options.Spacing = { 1.0, 1.0, 2.5 };
  const Scene inIndices = MakeScene(GetParam(), options);
  EXPECT_EQ(inIndices.Values, MakeScene(GetParam()).Values); // round in index coordinates
  EXPECT_EQ(inIndices.Spacing[2], 2.5);

  options.RoundInWorld = true;
  options.Size = { 96, 96, 38 };
  const Scene inWorld = MakeScene(GetParam(), options);
  // A wall of two voxels across is less than one along z.
  if (inWorld.OneIsoValueFits && GetParam() != SceneKind::ThinShellWithEightHoles)
  {
    ExpectPromisedTopology(inWorld);
  }
}

TEST_P(SyntheticScenes, MarkTheVoxelsInside)
{
  for (const bool bright : { true, false })
  {
    SceneOptions options;
    options.ObjectIsBright = bright;
    const Scene scene = MakeScene(GetParam(), options);
    std::size_t inside = 0, differing = 0;
    for (std::size_t voxel = 0; voxel < scene.Values.size(); ++voxel)
    {
      inside += scene.Inside[voxel];
      differing +=
        scene.Inside[voxel] != ((scene.Values[voxel] > scene.IsoValue) == scene.ObjectIsBright);
    }
    EXPECT_GT(inside, 1000u);
    if (scene.OneIsoValueFits)
    {
      EXPECT_EQ(differing, 0u);
    }
    else
    {
      EXPECT_GT(differing, 0u);
    }
  }
}

TEST_P(SyntheticScenes, ShowFromOutsideWhatTheyPromise)
{
  Scene scene = MakeScene(GetParam());
  if (!scene.OneIsoValueFits)
  {
    GTEST_SKIP() << "no iso-value fits this scene";
  }
  FillCavities(scene);
  const TopologyVerdict verdict = JudgeMarchingSurface(scene);
  EXPECT_EQ(static_cast<int>(verdict.Components.size()), scene.ComponentsFromOutside);
  EXPECT_EQ(verdict.Genus, scene.GenusFromOutside);
}

TEST_P(SyntheticScenes, HaveTheirSeedsInside)
{
  const Scene scene = MakeScene(GetParam());
  EXPECT_EQ(scene.Seeds.empty(), GetParam() == SceneKind::ThinShellWithEightHoles);
  for (const auto& seed : scene.Seeds)
  {
    EXPECT_GT(scene.SeedRadius, 2.0);
    volumic::ForVoxels(scene.Size,
      [&](int i, int j, int k)
      {
        const double distance = std::hypot(i - seed[0], j - seed[1], k - seed[2]);
        ASSERT_TRUE(distance > scene.SeedRadius || scene.Inside[VoxelAt(scene, i, j, k)]);
      });
  }
}

TEST_P(SyntheticScenes, HaveTheNoiseThatWasAskedFor)
{
  const Scene clean = MakeScene(GetParam());
  SceneOptions options;
  options.NoiseShare = 0.2;
  const Scene noisy = MakeScene(GetParam(), options);
  EXPECT_EQ(noisy.Values, MakeScene(GetParam(), options).Values);
  EXPECT_EQ(noisy.Inside, clean.Inside);
  double sum = 0.0, squares = 0.0;
  for (std::size_t voxel = 0; voxel < clean.Values.size(); ++voxel)
  {
    const double difference = noisy.Values[voxel] - clean.Values[voxel];
    sum += difference;
    squares += difference * difference;
  }
  const double contrast = clean.OneIsoValueFits ? 100.0 : 40.0;
  const double count = static_cast<double>(clean.Values.size());
  EXPECT_NEAR(sum / count, 0.0, 0.002 * contrast);
  EXPECT_NEAR(std::sqrt(squares / count), 0.2 * contrast, 0.002 * contrast);

  options.NoiseSeed = 2;
  EXPECT_NE(noisy.Values, MakeScene(GetParam(), options).Values);
}

TEST_P(SyntheticScenes, SurviveThePyramidAsFarAsTheySay)
{
  Scene level = MakeScene(GetParam());
  if (!level.OneIsoValueFits)
  {
    GTEST_SKIP() << "no iso-value fits this scene";
  }
  const std::array<int, 3> fullSize = level.Size;
  double unit = 1.0;
  for (int h = 1; h <= 3; ++h, unit *= std::sqrt(3.0))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      ReduceAxis(level, axis, unit, fullSize[axis]);
    }
    const TopologyVerdict verdict = JudgeMarchingSurface(level);
    const bool isRight = static_cast<int>(verdict.Components.size()) == level.Components &&
      verdict.Genus == level.Genus;
    EXPECT_EQ(isRight, h <= level.CoarsestFaithfulLevel) << "level " << h;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SyntheticScenes, ::testing::ValuesIn(AllSceneKinds()),
  [](const auto& instance) { return SceneName(instance.param); });

TEST(SyntheticSceneShaded, FitsNoIsoValue)
{
  for (const bool bright : { true, false })
  {
    SceneOptions options;
    options.ObjectIsBright = bright;
    const Scene scene = MakeScene(SceneKind::ShadedEllipsoid, options);
    ASSERT_FALSE(scene.OneIsoValueFits);
    float extreme[2][2] = { { 1e9f, -1e9f }, { 1e9f, -1e9f } };
    for (std::size_t voxel = 0; voxel < scene.Values.size(); ++voxel)
    {
      float* range = extreme[scene.Inside[voxel]];
      range[0] = std::min(range[0], scene.Values[voxel]);
      range[1] = std::max(range[1], scene.Values[voxel]);
    }
    EXPECT_LT(extreme[1][0], extreme[0][1]); // object reaches into the background's values
    EXPECT_LT(extreme[0][0], extreme[1][1]); // and the other way round
  }
}

TEST(SyntheticSceneClosedNestedBalls, AreNested)
{
  const TopologyVerdict verdict = JudgeMarchingSurface(MakeScene(SceneKind::ClosedNestedBalls));
  ASSERT_EQ(verdict.Components.size(), 3u);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(verdict.Components[c].Depth, c); // outside of the shell, its cavity, the ball
  }
}

TEST(SyntheticSceneInvalid, OptionsAreRefused)
{
  SceneOptions options;
  options.Size = { 64, 8, 64 };
  EXPECT_THROW(MakeScene(SceneKind::Sphere, options), std::invalid_argument);
  options = SceneOptions();
  options.Spacing[1] = 0.0;
  EXPECT_THROW(MakeScene(SceneKind::Sphere, options), std::invalid_argument);
  options = SceneOptions();
  options.EdgeWidth = 0.0;
  EXPECT_THROW(MakeScene(SceneKind::Sphere, options), std::invalid_argument);
  options = SceneOptions();
  options.NoiseShare = -0.1;
  EXPECT_THROW(MakeScene(SceneKind::Sphere, options), std::invalid_argument);
}
