// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTestTools.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
/** A filter with ShowLevels. Its preview is level 1 of 2. */
vtkSmartPointer<vtkVolumeToSurface> ShowingFilterOf(vtkImageData* image)
{
  return FilterOf<vtkVolumeToSurface>(image, [](vtkVolumeToSurface* f) { f->ShowLevelsOn(); });
}

/** Return the levels that a caller of GetNeedsUpdate() gets, in order. */
std::vector<int> LevelsShown(vtkDeformableSurface* filter)
{
  std::vector<int> levels;
  filter->GetNeedsUpdate();
  do
  {
    filter->Update();
    levels.push_back(static_cast<int>(FieldOf(filter->GetOutput(), "Level")));
  } while (filter->GetNeedsUpdate() && levels.size() < 9);
  return levels;
}

vtkSmartPointer<vtkImageData> LargeBall()
{
  return BallImage(180, 160, 128);
}
}

TEST(ShowLevels, OutputsLevelsOneByOne)
{
  const auto image = LargeBall();
  const auto filter = ShowingFilterOf(image);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 }));
  const auto atOnce = ShowingFilterOf(image);
  atOnce->ShowLevelsOff();
  atOnce->Update();
  EXPECT_TRUE(AreSameSurfaces(filter->GetOutput(), atOnce->GetOutput()));
  filter->SetIsoValue(40.0);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 })) << "again";
  filter->ShowLevelsOff();
  filter->SetIsoValue(45.0);
  EXPECT_EQ(LevelsShown(filter), std::vector<int>{ 0 });
}

TEST(ShowLevels, ShowsTheLevelThatWasStopped)
{
  for (const bool isPreview : { false, true })
  {
    const auto filter = ShowingFilterOf(LargeBall());
    filter->SetPreview(isPreview);
    filter->GetNeedsUpdate();
    {
      const StopAtText stop(filter, "Level 1, iteration", 1);
      filter->Update();
      ASSERT_EQ(StopReason(filter->GetOutput()), "cancelled");
    }
    EXPECT_FALSE(filter->GetNeedsUpdate());
    filter->GoOn();
    EXPECT_EQ(LevelsShown(filter), isPreview ? std::vector<int>{ 1 } : (std::vector<int>{ 1, 0 }));
  }
}

TEST(ShowLevels, HasNoEffectWithoutNeedsUpdate)
{
  const auto filter = ShowingFilterOf(LargeBall());
  filter->Update();
  EXPECT_EQ(FieldOf(filter->GetOutput(), "Level"), 0);
  EXPECT_FALSE(filter->GetNeedsUpdate());
}

TEST(ShowLevels, WarnsOnlyAtTheEnd)
{
  const auto image = LargeBall();
  Voxels(image)->SetComponent(0, 0, vtkMath::Nan());
  const auto filter = ShowingFilterOf(image);
  filter->SetKeepComponents(vtkDeformableSurface::LargeComponents);
  filter->SetMinimumComponentVolume(1e9);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->GetNeedsUpdate();
  filter->Update();
  EXPECT_EQ(warnings.Get(), "");
  ASSERT_TRUE(filter->GetNeedsUpdate());
  filter->Update();
  EXPECT_TRUE(warnings.Has("surface of level 0 is empty: Keep Components"));
  EXPECT_TRUE(warnings.Has("has 1 NaN voxel")) << warnings.Get();
}

TEST(ShowLevels, EndsAfterAnErrorAndAtTheTimeLimit)
{
  const auto filter = ShowingFilterOf(LargeBall());
  filter->GetNeedsUpdate();
  filter->Update();
  filter->SetIsoValue(1e5);
  ExpectErrorOf(filter, { "Iso Value is 100000" });
  EXPECT_FALSE(filter->GetNeedsUpdate());
  filter->SetIsoValue(50.0);
  filter->SetTimeLimit(1e-6);
  filter->Update();
  EXPECT_FALSE(filter->GetNeedsUpdate());
  filter->SetTimeLimit(0.0);
  EXPECT_EQ(LevelsShown(filter), (std::vector<int>{ 1, 0 }));
}
