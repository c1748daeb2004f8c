// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Includes ITK, which need not be there, thus only where it was found.

#include "LabelPeers.h"

#include "SupportVtkConversions.h"

#include <vtkFlyingEdges3D.h>

#include <itkAntiAliasBinaryImageFilter.h>
#include <itkImage.h>
#include <itkMultiThreaderBase.h>

#include <memory>

namespace volumic::bench
{
namespace
{

using Mask = itk::Image<unsigned char, 3>;
using Field = itk::Image<float, 3>;

/** 1 where the label is. */
Mask::Pointer MaskOf(vtkImageData* image, int label)
{
  auto mask = Mask::New();
  Mask::SizeType size;
  Mask::SpacingType spacing;
  for (unsigned int a = 0; a < 3; ++a)
  {
    size[a] = static_cast<itk::SizeValueType>(image->GetDimensions()[a]);
    spacing[a] = image->GetSpacing()[a];
  }
  mask->SetRegions(size);
  mask->SetSpacing(spacing);
  mask->Allocate();
  vtkDataArray* labels = image->GetPointData()->GetScalars();
  for (vtkIdType v = 0; v < labels->GetNumberOfTuples(); ++v)
  {
    mask->GetBufferPointer()[v] = labels->GetComponent(v, 0) == label;
  }
  return mask;
}

vtkSmartPointer<vtkPolyData> ZeroSurface(Field* field, vtkImageData* geometry)
{
  vtkNew<vtkFloatArray> values;
  values->SetArray(field->GetBufferPointer(), geometry->GetNumberOfPoints(), 1);
  vtkNew<vtkImageData> image;
  image->CopyStructure(geometry);
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> marching;
  marching->SetInputData(image);
  marching->SetValue(0, 0.0);
  marching->ComputeNormalsOff();
  marching->ComputeScalarsOff();
  marching->Update();
  return marching->GetOutput();
}

} // namespace

SurfaceJob AntiAliasedLabelJob(vtkImageData* image, int label)
{
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  const auto made = std::make_shared<vtkSmartPointer<vtkPolyData>>();
  SurfaceJob job;
  job.Work = [=]()
  {
    auto smooth = itk::AntiAliasBinaryImageFilter<Mask, Field>::New();
    smooth->SetInput(MaskOf(image, label));
    smooth->Update();
    *made = ZeroSurface(smooth->GetOutput(), image);
  };
  job.Result = [made]() { return support::ToTriangleSurface(*made); };
  return job;
}

} // namespace volumic::bench
