// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Includes ITK, which need not be there, thus only where it was found.

#include "SurfacePeersVtk.h"

#include "SupportVtkConversions.h"
#include "SurfaceBenchmarkVolume.h"

#include <itkImage.h>
#include <itkImageRegionIteratorWithIndex.h>
#include <itkMultiThreaderBase.h>
#include <itkThresholdSegmentationLevelSetImageFilter.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace volumic::bench
{
namespace
{

using Image = itk::Image<float, 3>;
using Segmentation = itk::ThresholdSegmentationLevelSetImageFilter<Image, Image>;

Image::Pointer MakeImage(const int size[3])
{
  auto image = Image::New();
  Image::SizeType itkSize;
  for (unsigned int a = 0; a < 3; ++a)
  {
    itkSize[a] = static_cast<itk::SizeValueType>(size[a]);
  }
  image->SetRegions(itkSize);
  image->Allocate();
  return image;
}

/** Negative inside a box whose sides are two voxels within the image. */
Image::Pointer BoxInside(const int size[3])
{
  Image::Pointer box = MakeImage(size);
  itk::ImageRegionIteratorWithIndex<Image> voxel(box, box->GetBufferedRegion());
  for (; !voxel.IsAtEnd(); ++voxel)
  {
    float distance = -std::numeric_limits<float>::infinity();
    for (unsigned int a = 0; a < 3; ++a)
    {
      const auto place = static_cast<float>(voxel.GetIndex()[a]);
      distance = std::max({ distance, 2.0f - place, place - (static_cast<float>(size[a]) - 3.0f) });
    }
    voxel.Set(distance);
  }
  return box;
}

void CopyInto(vtkImageData* image, Image* result)
{
  const int* size = image->GetDimensions();
  float* voxel = result->GetBufferPointer();
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i)
      {
        *voxel++ = static_cast<float>(image->GetScalarComponentAsDouble(i, j, k, 0));
      }
    }
  }
}

vtkSmartPointer<vtkPolyData> ZeroSurface(Image* levelSet, const int* size)
{
  vtkNew<vtkFloatArray> values;
  values->SetArray(levelSet->GetBufferPointer(),
    static_cast<vtkIdType>(levelSet->GetBufferedRegion().GetNumberOfPixels()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(size);
  image->GetPointData()->SetScalars(values);
  return FlyingEdges(image, 0.0);
}

} // namespace

SurfaceJob LevelSetJob(vtkImageData* image, double isoValue, bool objectIsBright)
{
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  double range[2];
  image->GetScalarRange(range);
  const auto result = std::make_shared<vtkSmartPointer<vtkPolyData>>();
  const auto iterations = std::make_shared<double>(0.0);
  const Image::Pointer feature = MakeImage(image->GetDimensions());
  CopyInto(image, feature);
  SurfaceJob job;
  job.Work = [=]()
  {
    auto segmentation = Segmentation::New();
    segmentation->SetInput(BoxInside(image->GetDimensions()));
    segmentation->SetFeatureImage(feature);
    // The speed is the distance to the nearer threshold: the other one is put out of reach.
    const double reach = range[1] - range[0];
    segmentation->SetLowerThreshold(
      static_cast<float>(objectIsBright ? isoValue : range[0] - 2.0 * reach));
    segmentation->SetUpperThreshold(
      static_cast<float>(objectIsBright ? range[1] + 2.0 * reach : isoValue));
    segmentation->SetPropagationScaling(1.0f);
    segmentation->SetCurvatureScaling(1.0f);
    segmentation->SetIsoSurfaceValue(0.0f);
    segmentation->SetMaximumRMSError(0.02);
    segmentation->SetNumberOfIterations(1200);
    segmentation->Update();
    *iterations = static_cast<double>(segmentation->GetElapsedIterations());
    *result = ZeroSurface(segmentation->GetOutput(), image->GetDimensions());
  };
  job.Iterations = [iterations]() { return *iterations; };
  std::array<double, 3> steps;
  image->GetSpacing(steps.data());
  job.Result = [result, steps]()
  {
    // ITK's level sets work in voxels, whatever their distances.
    support::TriangleSurface surface = Stretched(support::ToTriangleSurface(*result), steps);
    // Inward as it comes: the level set grows toward the outside.
    for (auto& triangle : surface.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
    return surface;
  };
  return job;
}

} // namespace volumic::bench
