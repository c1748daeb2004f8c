// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfacePeersVtk.h"

#include "SupportVtkConversions.h"

#include <vtkFlyingEdges3D.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkQuadricDecimation.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>
#include <memory>

namespace volumic::bench
{
namespace
{

/** A job whose work makes a poly data. */
SurfaceJob PolyDataJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make)
{
  const auto made = std::make_shared<vtkSmartPointer<vtkPolyData>>();
  SurfaceJob job;
  job.Work = [made, make]() { *made = make(); };
  job.Result = [made]() { return support::ToTriangleSurface(*made); };
  return job;
}

} // namespace

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue)
{
  vtkNew<vtkFlyingEdges3D> marching;
  marching->SetInputData(image);
  marching->SetValue(0, isoValue);
  marching->ComputeNormalsOff();
  marching->ComputeScalarsOff();
  marching->Update();
  return marching->GetOutput();
}

vtkSmartPointer<vtkPolyData> Smoothed(vtkImageData* image, double isoValue)
{
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputData(FlyingEdges(image, isoValue));
  largest->SetExtractionModeToLargestRegion();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(largest->GetOutputPort());
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  return smooth->GetOutput();
}

//------------------------------------------------------------------------------
SurfaceJob FlyingEdgesJob(vtkImageData* image, double isoValue)
{
  return PolyDataJob([=]() { return FlyingEdges(image, isoValue); });
}

SurfaceJob SmoothedJob(vtkImageData* image, double isoValue)
{
  return PolyDataJob([=]() { return Smoothed(image, isoValue); });
}

SurfaceJob DecimatedJob(vtkImageData* image, double isoValue, long long vertices)
{
  return PolyDataJob(
    [=]()
    {
      const vtkSmartPointer<vtkPolyData> smoothed = Smoothed(image, isoValue);
      // Two triangles per vertex, as on any large closed surface. (Points are no measure: those of
      // the other components are still there.)
      const double share =
        2.0 * static_cast<double>(vertices) / static_cast<double>(smoothed->GetNumberOfPolys());
      vtkNew<vtkQuadricDecimation> decimate;
      decimate->SetInputData(smoothed);
      decimate->SetTargetReduction(std::max(0.0, 1.0 - share));
      decimate->Update();
      return vtkSmartPointer<vtkPolyData>(decimate->GetOutput());
    });
}

} // namespace volumic::bench
