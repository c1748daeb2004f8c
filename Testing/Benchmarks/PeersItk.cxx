// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The only file that includes ITK, which need not be there.

#include "Benchmark.h"

#include "SupportVtkConversions.h"

#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>
#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkResampleImageFilter.h>
#include <itkThresholdSegmentationLevelSetImageFilter.h>

#include <limits>
#include <memory>

namespace volumic::bench
{
namespace
{

using Scalars = itk::Image<float, 3>;
using Shorts = itk::Image<short, 3>;

/** Voxels by a function of the number of a VTK image's voxel; ITK works in voxels. */
template <typename Get>
Scalars::Pointer MakeImage(vtkImageData* like, const Get& get)
{
  auto image = Scalars::New();
  Scalars::SizeType size;
  for (unsigned int a = 0; a < 3; ++a)
  {
    size[a] = static_cast<itk::SizeValueType>(like->GetDimensions()[a]);
  }
  image->SetRegions(size);
  image->Allocate();
  for (vtkIdType v = 0; v < like->GetNumberOfPoints(); ++v)
  {
    image->GetBufferPointer()[v] = static_cast<float>(get(v));
  }
  return image;
}

/** Negative inside a box whose sides are two voxels within the image. */
Scalars::Pointer BoxInside(vtkImageData* image)
{
  const int* size = image->GetDimensions();
  return MakeImage(image,
    [size](vtkIdType v)
    {
      vtkIdType rest = v;
      double distance = -std::numeric_limits<double>::infinity();
      for (int a = 0; a < 3; ++a)
      {
        const double place = static_cast<double>(rest % size[a]);
        rest /= size[a];
        distance = std::max({ distance, 2.0 - place, place - (size[a] - 3.0) });
      }
      return distance;
    });
}

/** Where the values are 0, with the image's geometry. */
vtkSmartPointer<vtkPolyData> ZeroSurface(Scalars* field, vtkImageData* geometry)
{
  vtkNew<vtkFloatArray> values;
  values->SetArray(field->GetBufferPointer(), geometry->GetNumberOfPoints(), 1);
  vtkNew<vtkImageData> image;
  image->CopyStructure(geometry);
  image->GetPointData()->SetScalars(values);
  return FlyingEdges(image, 0.0);
}

template <typename Input>
Scalars::Pointer MakeLevel(
  typename Input::Pointer input, const std::array<int, 3>& size, int threads)
{
  auto smooth = itk::DiscreteGaussianImageFilter<Input, Scalars>::New();
  smooth->SetInput(input);
  smooth->SetUseImageSpacing(false);
  smooth->SetVariance(1.0);
  smooth->SetMaximumKernelWidth(5);
  smooth->SetNumberOfWorkUnits(threads);
  Scalars::SizeType outputSize;
  Scalars::SpacingType outputSpacing;
  for (unsigned int a = 0; a < 3; ++a)
  {
    outputSize[a] = static_cast<itk::SizeValueType>(size[a]);
    outputSpacing[a] =
      input->GetSpacing()[a] * input->GetLargestPossibleRegion().GetSize()[a] / size[a];
  }
  // Identity transform and linear interpolation are its defaults.
  auto resample = itk::ResampleImageFilter<Scalars, Scalars>::New();
  resample->SetInput(smooth->GetOutput());
  resample->SetSize(outputSize);
  resample->SetOutputSpacing(outputSpacing);
  resample->SetOutputOrigin(input->GetOrigin());
  resample->SetNumberOfWorkUnits(threads);
  resample->Update();
  return resample->GetOutput();
}

} // namespace

Job LevelSetJob(vtkImageData* image, double isoValue)
{
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  vtkDataArray* voxels = image->GetPointData()->GetScalars();
  const Scalars::Pointer feature =
    MakeImage(image, [voxels](vtkIdType v) { return voxels->GetComponent(v, 0); });
  return PolyDataJob(
    [=]()
    {
      auto segmentation = itk::ThresholdSegmentationLevelSetImageFilter<Scalars, Scalars>::New();
      segmentation->SetInput(BoxInside(image));
      segmentation->SetFeatureImage(feature);
      // The speed is the distance to the nearer threshold: the other one is put out of reach.
      double range[2];
      image->GetScalarRange(range);
      segmentation->SetLowerThreshold(static_cast<float>(isoValue));
      segmentation->SetUpperThreshold(static_cast<float>(range[1] + 2.0 * (range[1] - range[0])));
      segmentation->SetPropagationScaling(1.0f);
      segmentation->SetCurvatureScaling(1.0f);
      segmentation->SetIsoSurfaceValue(0.0f);
      segmentation->SetMaximumRMSError(0.02);
      segmentation->SetNumberOfIterations(1200);
      segmentation->Update();
      return ZeroSurface(segmentation->GetOutput(), image);
    });
}

void RunItkPyramid(vtkImageData* volume, const std::vector<std::array<int, 3>>& sizes, int threads)
{
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(threads);
  auto import = itk::ImportImageFilter<short, 3>::New();
  Shorts::RegionType region;
  for (unsigned int a = 0; a < 3; ++a)
  {
    region.SetSize(a, static_cast<itk::SizeValueType>(volume->GetDimensions()[a]));
  }
  import->SetRegion(region);
  import->SetSpacing(volume->GetSpacing());
  import->SetImportPointer(static_cast<short*>(volume->GetScalarPointer()),
    static_cast<itk::SizeValueType>(volume->GetNumberOfPoints()), false);
  import->Update();
  Scalars::Pointer level = MakeLevel<Shorts>(import->GetOutput(), sizes[0], threads);
  for (std::size_t h = 1; h < sizes.size(); ++h)
  {
    level = MakeLevel<Scalars>(level, sizes[h], threads);
  }
}

} // namespace volumic::bench
