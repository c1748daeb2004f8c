// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The only file that includes ITK, which need not be there.

#include "PyramidPeers.h"

#include <vtkImageData.h>

#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>
#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkResampleImageFilter.h>

namespace volumic::bench
{
namespace
{

using FloatImage = itk::Image<float, 3>;
using ShortImage = itk::Image<short, 3>;

template <typename TImage>
FloatImage::Pointer MakeLevel(
  typename TImage::Pointer input, const std::array<int, 3>& size, int threads)
{
  using Smooth = itk::DiscreteGaussianImageFilter<TImage, FloatImage>;
  auto smooth = Smooth::New();
  smooth->SetInput(input);
  smooth->SetUseImageSpacing(false);
  smooth->SetVariance(1.0);
  smooth->SetMaximumKernelWidth(5);
  smooth->SetNumberOfWorkUnits(threads);

  typename FloatImage::SizeType outputSize;
  typename FloatImage::SpacingType outputSpacing;
  for (unsigned int a = 0; a < 3; ++a)
  {
    outputSize[a] = static_cast<itk::SizeValueType>(size[a]);
    outputSpacing[a] =
      input->GetSpacing()[a] * input->GetLargestPossibleRegion().GetSize()[a] / size[a];
  }
  // Identity transform and linear interpolation are its defaults.
  auto resample = itk::ResampleImageFilter<FloatImage, FloatImage>::New();
  resample->SetInput(smooth->GetOutput());
  resample->SetSize(outputSize);
  resample->SetOutputSpacing(outputSpacing);
  resample->SetOutputOrigin(input->GetOrigin());
  resample->SetNumberOfWorkUnits(threads);
  resample->Update();
  return resample->GetOutput();
}

} // namespace

void RunItkPyramid(vtkImageData* volume, const LevelSizes& sizes, int threads)
{
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(threads);
  auto import = itk::ImportImageFilter<short, 3>::New();
  ShortImage::RegionType region;
  for (unsigned int a = 0; a < 3; ++a)
  {
    region.SetSize(a, static_cast<itk::SizeValueType>(volume->GetDimensions()[a]));
  }
  import->SetRegion(region);
  import->SetSpacing(volume->GetSpacing());
  import->SetImportPointer(static_cast<short*>(volume->GetScalarPointer()),
    static_cast<itk::SizeValueType>(volume->GetNumberOfPoints()), false);
  import->Update();

  FloatImage::Pointer level = MakeLevel<ShortImage>(import->GetOutput(), sizes[0], threads);
  for (std::size_t h = 1; h < sizes.size(); ++h)
  {
    level = MakeLevel<FloatImage>(level, sizes[h], threads);
  }
}

} // namespace volumic::bench
