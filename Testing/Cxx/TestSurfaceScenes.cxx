// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Acceptance scenes of vtkDeformableSurface with known topology, tested by an independent judge.
#include "SupportVtkConversions.h"
#include "SurfaceTestTools.h"

#include <tuple>

using namespace volumic;
using namespace volumic::support;

namespace
{
vtkSmartPointer<vtkDeformableSurface> Segment(vtkImageData* image, const Scene& scene)
{
  const auto filter = FilterOf(image);
  filter->SetIsoValue(scene.IsoValue);
  filter->SetObjectIsBright(scene.ObjectIsBright);
  return filter;
}

/** Expect the guarantees of output surfaces. */
void ExpectInvariants(vtkPolyData* surface, vtkImageData* image, int metric)
{
  // Computational space: world or index coordinates.
  const bool isWorld = metric == vtkDeformableSurface::World;
  const double worldUnit =
    isWorld ? 1.0 : FieldOf(surface, "Unit") / std::pow(3.0, FieldOf(surface, "Level") / 2);
  const SurfaceVerdict verdict = JudgeSurface(
    ToTriangleSurface(surface, isWorld ? nullptr : image), FieldOf(surface, "Delta") / worldUnit);
  SCOPED_TRACE(Describe(verdict));
  EXPECT_TRUE(verdict.IsSound());
  EXPECT_EQ(verdict.Lengths.EdgesTooLong, 0u);
  EXPECT_EQ(verdict.Lengths.EdgesTooShort, 0u);
  EXPECT_EQ(verdict.Topology.EulerCharacteristic, FieldOf(surface, "EulerCharacteristic"));
  EXPECT_EQ(verdict.Topology.Genus, FieldOf(surface, "Genus"));
  EXPECT_EQ(verdict.Topology.Components.size(), FieldOf(surface, "NumberOfComponents"));
}

void ExpectInvariantsAtEveryLevel(vtkDeformableSurface* filter, vtkImageData* image)
{
  for (unsigned int h = 0; h < filter->GetLevels()->GetNumberOfBlocks(); ++h)
  {
    SCOPED_TRACE("level " + std::to_string(h));
    vtkPolyData* surface = SurfaceAt(filter, h);
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      ExpectInvariants(surface, image, filter->GetMetric());
    }
  }
}

void ExpectTopology(vtkDeformableSurface* filter, const Scene& scene)
{
  vtkPolyData* surface = filter->GetOutput();
  ASSERT_GT(surface->GetNumberOfPoints(), 0);
  EXPECT_EQ(FieldOf(surface, "Level"), 0);
  EXPECT_EQ(FieldOf(surface, "NumberOfComponents"), scene.Components);
  EXPECT_EQ(FieldOf(surface, "Genus"), scene.Genus);
  EXPECT_EQ(StopReason(surface), "converged");
}

/** Sampling and segmentation of a scene. */
struct Variant
{
  const char* Name;
  double NoiseShare = 0.0;
  bool WithPyramid = true;
  bool ObjectIsBright = true;
  double SliceSpacing = 1.0;
  int Metric = vtkDeformableSurface::World;
};

class SurfaceOfScene : public ::testing::TestWithParam<std::tuple<SceneKind, Variant>>
{
};
}

TEST_P(SurfaceOfScene, HasCorrectTopologyAndIsValid)
{
  const auto& [kind, variant] = GetParam();
  SceneOptions options;
  options.NoiseShare = variant.NoiseShare;
  // For some seeds, noise makes a real hole in the wall of two voxels.
  options.NoiseSeed = 4;
  options.ObjectIsBright = variant.ObjectIsBright;
  options.Spacing[2] = variant.SliceSpacing;
  const Scene scene = MakeScene(kind, options);
  const auto image = ToImage(scene);
  const auto filter = Segment(image, scene);
  filter->SetMetric(variant.Metric);
  filter->SetCoarsestLevel(variant.WithPyramid ? scene.CoarsestFaithfulLevel : 0);
  filter->Update();
  ExpectTopology(filter, scene);
  ExpectInvariantsAtEveryLevel(filter, image);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SurfaceOfScene,
  ::testing::Combine(::testing::Values(SceneKind::Sphere, SceneKind::TwoSpheres, SceneKind::Torus,
                       SceneKind::BoxWithTwoTunnels, SceneKind::ShellWithOpening,
                       SceneKind::NestedBalls, SceneKind::ThinShellWithEightHoles),
    ::testing::Values(Variant{ "Clean" }, Variant{ "CleanWithoutPyramid", 0.0, false },
      Variant{ "Noisy", 0.2 }, Variant{ "NoisyWithoutPyramid", 0.2, false },
      Variant{ "Dark", 0.0, true, false }, Variant{ "LongVoxels", 0.0, true, true, 2.5 },
      Variant{ "LongVoxelsInTheirMetric", 0.0, true, true, 2.5, vtkDeformableSurface::Voxels })),
  [](const ::testing::TestParamInfo<std::tuple<SceneKind, Variant>>& info)
  { return SceneName(std::get<0>(info.param)) + std::get<1>(info.param).Name; });

TEST(SurfaceScenes, SeedsMergeIntoOneSurface)
{
  for (const SceneKind kind : { SceneKind::Sphere, SceneKind::Torus })
  {
    const Scene scene = MakeScene(kind);
    const auto image = ToImage(scene);
    ASSERT_GE(scene.Seeds.size(), 2u);
    const auto filter = Segment(image, scene);
    filter->SetCoarsestLevel(0);
    filter->SetInitializationToSeeds();
    filter->SetSeedRadius(scene.SeedRadius);
    filter->SetInitialSurfaceData(PointsAt(scene.Seeds));
    filter->Update();
    ExpectTopology(filter, scene);
    ExpectInvariantsAtEveryLevel(filter, image);
  }
}

TEST(SurfaceScenes, SnapshotsAreValid)
{
  for (const SceneKind kind :
    { SceneKind::Torus, SceneKind::NestedBalls, SceneKind::ThinShellWithEightHoles })
  {
    for (const bool isNoisy : { false, true })
    {
      SceneOptions options;
      options.NoiseShare = isNoisy ? 0.2 : 0.0;
      options.NoiseSeed = 3;
      const Scene scene = MakeScene(kind, options);
      const auto filter = Segment(ToImage(scene), scene);
      filter->SetCoarsestLevel(isNoisy ? 0 : scene.CoarsestFaithfulLevel);
      filter->SetSnapshotInterval(10);
      filter->Update();
      vtkMultiBlockDataSet* snapshots = filter->GetSnapshots();
      ASSERT_GT(snapshots->GetNumberOfBlocks(), 4u);
      for (unsigned int b = 0; b < snapshots->GetNumberOfBlocks(); ++b)
      {
        SCOPED_TRACE(SceneName(kind) + ", snapshot " + std::to_string(b));
        auto* surface = vtkPolyData::SafeDownCast(snapshots->GetBlock(b));
        const TriangleSurface judged = ToTriangleSurface(surface);
        const TopologyVerdict topology = JudgeTopology(judged);
        EXPECT_TRUE(topology.Closed && topology.Manifold && topology.Oriented);
        EXPECT_EQ(JudgeIntersections(judged).Pairs, 0u);
        // Eq. (1), except for edges whose split would make a needle (HugeEdge).
        const double delta = FieldOf(surface, "Delta");
        const LengthVerdict lengths = JudgeLengths(judged, delta);
        EXPECT_LE(lengths.Longest, 1.4 * 2.5 * delta);
        EXPECT_LE(lengths.EdgesTooLong, 3u);
      }
    }
  }
}

TEST(SurfaceScenes, JudgeDetectsHolesAndIntersections)
{
  TriangleSurface surface;
  surface.Points = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, { 0, 0, 2 } };
  surface.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  EXPECT_TRUE(JudgeTopology(surface).Outward);
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 0u);
  surface.Points.insert(
    surface.Points.end(), { { 0.4, 0.4, -1 }, { 0.5, 0.4, 1 }, { 0.4, 0.5, 1 } });
  surface.Triangles.push_back({ 4, 5, 6 });
  EXPECT_EQ(JudgeIntersections(surface).Pairs, 1u) << "intersection with the bottom";
  EXPECT_FALSE(JudgeTopology(surface).Closed);
}
