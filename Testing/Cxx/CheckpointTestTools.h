// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCheckpointTestTools_h
#define volumicCheckpointTestTools_h

#include "SameOutputs.h"
#include "TemporaryFolder.h"
#include "vtkVolumeToSurface.h"

namespace volumic
{
/** A ball, and a rod that coarse levels do not show. */
inline vtkSmartPointer<vtkImageData> CheckpointScene(int size = 44)
{
  const auto image = BallImage(size, size, size, 0.3);
  FillBox(image, { 4, 4, 5 }, { 7, 7, size - 5 });
  return image;
}

class Checkpoints : public ::testing::Test
{
public:
  /** Another process would have one of its own, too. */
  vtkSmartPointer<vtkVolumeToSurface> NewFilter(const Choice& choose = {}) const
  {
    const auto filter = FilterOf<vtkVolumeToSurface>(this->Image);
    filter->SetScratchDirectory(this->Folder.Path().c_str());
    if (choose)
    {
      choose(filter);
    }
    return filter;
  }

  /** Leaves a checkpoint of a run that was stopped. */
  void StopARun(const Choice& choose = {}, const std::string& where = "Level 0, iteration 5") const
  {
    const auto filter = this->NewFilter(choose);
    const StopAtText stop(filter, where, 1);
    filter->Update();
    ASSERT_LE(stop.Left, 0);
  }

  vtkSmartPointer<vtkVolumeToSurface> Resume(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    filter->ResumeOn();
    filter->Update();
    return filter;
  }

  /** As it is without any checkpoint. */
  vtkSmartPointer<vtkVolumeToSurface> Uninterrupted(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    filter->SetScratchDirectory("");
    filter->Update();
    return filter;
  }

  /** The error of a run that is to go on, which has no surface. */
  std::string ErrorOfResuming(const Choice& choose = {}) const
  {
    const auto filter = this->NewFilter(choose);
    const MessagesOf errors(filter);
    filter->ResumeOn();
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    return errors.Get();
  }

  /** That of the only checkpoint there is. */
  std::string CheckpointFolder() const
  {
    const std::set<std::string> names = this->Folder.Names();
    EXPECT_EQ(names.size(), 1u);
    return names.empty() ? "" : this->Folder.File(*names.begin());
  }

  TemporaryFolder Folder;
  vtkSmartPointer<vtkImageData> Image = CheckpointScene();
};
}

#endif
