// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceBenchmarkVolume.h"

#include "SupportVtkConversions.h"

#include <vtkImageConstantPad.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace volumic::bench
{
namespace
{

vtkSmartPointer<vtkImageData> ReadScalars(const std::string& file)
{
  vtkNew<vtkXMLImageDataReader> reader;
  if (!reader->CanReadFile(file.c_str()))
  {
    throw std::runtime_error(file + ": not a readable .vti file");
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  vtkPointData* points = image->GetPointData();
  if (!points->GetScalars() && points->GetNumberOfArrays() > 0)
  {
    points->SetActiveScalars(points->GetArrayName(0));
  }
  if (!points->GetScalars() || points->GetScalars()->GetNumberOfComponents() != 1)
  {
    throw std::runtime_error(file + ": has no point scalars of one component");
  }
  return image;
}

BenchmarkedVolume MakeVolume(const SurfaceBenchmarkOptions& options)
{
  for (const support::SceneKind kind : support::AllSceneKinds())
  {
    if (support::SceneName(kind) == options.Scene)
    {
      support::SceneOptions sceneOptions;
      sceneOptions.Size = { options.SceneSize, options.SceneSize, options.SceneSize };
      sceneOptions.ObjectIsBright = options.ObjectIsBright;
      const support::Scene scene = support::MakeScene(kind, sceneOptions);
      return { support::ToImage(scene), scene.IsoValue, scene.ObjectIsBright };
    }
  }
  std::string known;
  for (const support::SceneKind kind : support::AllSceneKinds())
  {
    known += " " + support::SceneName(kind);
  }
  throw std::runtime_error("no scene \"" + options.Scene + "\"; there are" + known);
}

} // namespace

//------------------------------------------------------------------------------
BenchmarkedVolume LoadVolume(const SurfaceBenchmarkOptions& options)
{
  BenchmarkedVolume volume;
  if (options.Scene.empty())
  {
    volume.Image = ReadScalars(options.Volume);
    volume.ObjectIsBright = options.ObjectIsBright;
  }
  else
  {
    volume = MakeVolume(options);
  }
  if (!std::isnan(options.IsoValue))
  {
    volume.IsoValue = options.IsoValue;
  }
  if (options.ResampleTo > 0)
  {
    volume.Image = Resampled(volume.Image, options.ResampleTo);
  }
  return volume;
}

RunFigures WriteVolume(const SurfaceBenchmarkOptions& options)
{
  const BenchmarkedVolume volume = LoadVolume(options);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(volume.Image);
  writer->SetFileName(options.WriteVolume.c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  if (!writer->Write() || writer->GetErrorCode() != 0)
  {
    throw std::runtime_error(options.WriteVolume + ": can't be written");
  }
  RunFigures figures;
  figures.Set("IsoValue", volume.IsoValue);
  figures.Set("BytesOfVoxel", volume.Image->GetScalarSize());
  return figures;
}

vtkSmartPointer<vtkImageData> Resampled(vtkImageData* image, int size)
{
  int dimensions[3], extent[6];
  double spacing[3], origin[3];
  image->GetDimensions(dimensions);
  image->GetExtent(extent);
  image->GetSpacing(spacing);
  const double factor =
    size / std::cbrt(static_cast<double>(dimensions[0]) * dimensions[1] * dimensions[2]);
  int newExtent[6];
  for (int a = 0; a < 3; ++a)
  {
    const int count = std::max(8, static_cast<int>(std::lround(factor * dimensions[a])));
    newExtent[2 * a] = 0;
    newExtent[2 * a + 1] = count - 1;
    spacing[a] *= (dimensions[a] - 1.0) / (count - 1.0);
  }
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], origin);
  // Reslicing happens along the axes of the image: its direction is taken away and given back.
  vtkNew<vtkImageData> straight;
  straight->ShallowCopy(image);
  straight->SetDirectionMatrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  double straightOrigin[3];
  straight->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], straightOrigin);
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(straight);
  reslice->SetInterpolationModeToLinear();
  reslice->SetOutputExtent(newExtent);
  reslice->SetOutputSpacing(spacing);
  reslice->SetOutputOrigin(straightOrigin);
  reslice->BorderOn(); // rounding must not put the last voxels outside
  reslice->Update();
  vtkSmartPointer<vtkImageData> result = reslice->GetOutput();
  result->SetDirectionMatrix(image->GetDirectionMatrix());
  result->SetOrigin(origin);
  return result;
}

vtkSmartPointer<vtkImageData> InAir(vtkImageData* image, bool objectIsBright)
{
  double range[2];
  image->GetScalarRange(range);
  const int* extent = image->GetExtent();
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputData(image);
  pad->SetConstant(range[objectIsBright ? 0 : 1]);
  pad->SetOutputWholeExtent(
    extent[0] - 1, extent[1] + 1, extent[2] - 1, extent[3] + 1, extent[4] - 1, extent[5] + 1);
  pad->Update();
  return pad->GetOutput();
}

std::array<double, 3> StepsOf(vtkImageData* image, LengthMetric metric)
{
  std::array<double, 3> steps;
  image->GetSpacing(steps.data());
  const double least = std::min({ steps[0], steps[1], steps[2] });
  for (double& step : steps)
  {
    step = metric == LengthMetric::World ? step / least : 1.0;
  }
  return steps;
}

support::TriangleSurface Stretched(
  support::TriangleSurface surface, const std::array<double, 3>& factors)
{
  for (auto& point : surface.Points)
  {
    for (int a = 0; a < 3; ++a)
    {
      point[a] *= factors[a];
    }
  }
  return surface;
}

vtkSmartPointer<vtkImageData> InSteps(vtkImageData* image, const std::array<double, 3>& steps)
{
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetDimensions(image->GetDimensions());
  result->SetSpacing(steps.data());
  result->GetPointData()->SetScalars(image->GetPointData()->GetScalars());
  return result;
}

} // namespace volumic::bench
