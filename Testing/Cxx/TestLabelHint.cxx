// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelImages.h"
#include "vtkVolumeToSurface.h"

using namespace volumic;

namespace
{
/** What vtkVolumeToSurface warns of. */
std::string WarningsOf(vtkVolumeToSurface* filter, vtkImageData* image)
{
  filter->SetInputData(image);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 0) << "it is made all the same";
  return warnings.Get();
}
}

TEST(LabelHint, WhoGivesALabelMapToVolumeToSurfaceIsToldOnce)
{
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT })
  {
    vtkNew<vtkVolumeToSurface> filter;
    filter->SetIsoValue(0.5);
    const std::string warnings =
      WarningsOf(filter, LabelImageOf(34, 28, 28, TwoBalls, type));
    EXPECT_TRUE(Has(warnings, "array 'Labels' looks like a label map: 3 different integers"));
    EXPECT_TRUE(Has(warnings, "Labels to Surfaces"));
    EXPECT_EQ(WarningsOf(filter, LabelImageOf(34, 28, 28, TwoBalls, type)), "") << "once";
  }
}

TEST(LabelHint, IsToldAtTheEndOfTheRun)
{
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetInputData(LabelImageOf(34, 28, 28, TwoBalls, VTK_SHORT));
  filter->SetIsoValue(0.5);
  const MessagesOf warnings(filter, vtkCommand::WarningEvent);
  std::string early;
  const ProgressHook hook(filter,
    [&](vtkAlgorithm*, const std::string&, double share)
    { early += share < 1.0 ? warnings.Get() : ""; }); // At 1 the filter is done.
  filter->Update();
  EXPECT_EQ(early, "");
  EXPECT_TRUE(warnings.Has("looks like a label map"));
}

TEST(LabelHint, ScansAreNoLabelMaps)
{
  vtkNew<vtkVolumeToSurface> filter;
  filter->SetIsoValue(50.);
  EXPECT_EQ(WarningsOf(filter, BallImage(30, 30, 30)), "");
  // Of noise something may be lost, which is told.
  EXPECT_FALSE(Has(WarningsOf(filter, RandomImage(20, 20, 20, VTK_UNSIGNED_CHAR)), "label map"));
  // Integers of 8 bits that change from voxel to voxel.
  const auto soft = [](int i, int j, int k)
  { return std::floor(100. - 5. * std::hypot(i - 14., j - 14., k - 14.)); };
  EXPECT_EQ(WarningsOf(filter, LabelImageOf(28, 28, 28, soft, VTK_SIGNED_CHAR)), "");
}
