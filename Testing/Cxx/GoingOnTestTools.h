// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGoingOnTestTools_h
#define volumicGoingOnTestTools_h

#include "SameOutputs.h"
#include "vtkVolumeToSurface.h"

namespace volumic
{
/** A ball, a thin rod and a bubble: something is lost, found again and merged. */
inline vtkSmartPointer<vtkImageData> GoingOnScene(int size = 64)
{
  const auto image = BallImage(size, size, size, 0.3);
  FillBox(image, { 5, 5, 6 }, { 8, 8, size - 6 });
  return image;
}

/** What a run from the start gives. */
inline vtkSmartPointer<vtkDeformableSurface> FromTheStart(
  vtkDataObject* input, int finest, const Choice& choose = {})
{
  const auto filter = FilterOf(input, choose);
  filter->SetFinestLevel(finest);
  filter->Update();
  return filter;
}

/** Updates; @return whether levels coarser than `level` have iterated, or the pyramid was built. */
inline bool Reruns(vtkAlgorithm* filter, int level)
{
  ProgressListener listener(filter);
  filter->Update();
  filter->RemoveAllObservers();
  return std::any_of(listener.Texts.begin(), listener.Texts.end(),
    [level](const std::string& text)
    {
      bool isRerun = bool(Has(text, "Building the pyramid"));
      for (int coarse = level + 1; coarse < 9; ++coarse)
      {
        isRerun = isRerun || Has(text, "Level " + std::to_string(coarse) + ", iteration");
      }
      return isRerun;
    });
}

/**
 * Updates; @return whether nothing at all is worked on. (The last text of the run before stays.)
 */
inline bool ShowsAtOnce(vtkAlgorithm* filter)
{
  ProgressListener listener(filter);
  filter->Update();
  filter->RemoveAllObservers();
  return listener.Texts.size() <= 1;
}

class GoingOn : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Filter->SetInputData(this->Image);
    this->Filter->SetIsoValue(50.0);
  }

  vtkSmartPointer<vtkImageData> Image = GoingOnScene();
  vtkNew<vtkDeformableSurface> Filter;
};
}

#endif
