// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/InitialSurfaces.h"

#include "Core/Common/Executor.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/Field.h"
#include "Input/InputPoints.h"
#include "Input/Workspace.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace volumic
{
namespace
{
/** Points that no triangle uses are left out. */
IndexedSurface Triangles(vtkPolyData* polyData)
{
  IndexedSurface surface;
  std::vector<int> index(static_cast<std::size_t>(polyData->GetNumberOfPoints()), -1);
  auto cells = vtk::TakeSmartPointer(polyData->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* ids;
    cells->GetCurrentCell(size, ids);
    Triangle triangle;
    for (int corner = 0; corner < 3; ++corner)
    {
      int& place = index[ids[corner]];
      if (place < 0)
      {
        place = static_cast<int>(surface.Points.size());
        Point point;
        polyData->GetPoint(ids[corner], point.data());
        surface.Points.push_back(point);
      }
      triangle[corner] = place;
    }
    surface.Triangles.push_back(triangle);
  }
  return surface;
}

/** The level with a voxel of background on all sides. */
vtkSmartPointer<vtkImageData> PadByBackground(
  const LevelImage& image, const SurfaceOptions& options)
{
  auto padded = vtkSmartPointer<vtkImageData>::New();
  padded->SetExtent(-1, image.Size[0], -1, image.Size[1], -1, image.Size[2]);
  padded->SetSpacing(image.Step.data());
  padded->AllocateScalars(VTK_FLOAT, 1);
  auto* values = static_cast<float*>(padded->GetScalarPointer());
  // The background that the field has there: an image may have none within.
  SequentialExecutor thread;
  const Field field(image, options, thread);
  std::fill(values, values + padded->GetNumberOfPoints(), field.Background());
  // Through a voxel at the iso-value itself the triangles would be of no size: such voxels are
  // moved a little to the side of the background. The surface finds its place anyway.
  const float iso = static_cast<float>(options.IsoValue - image.Base);
  const float room = 0.01f * std::max(field.Highest(), -field.Lowest());
  const float beside = options.ObjectIsBright ? iso - room : iso + room;
  const auto clear = [&](float value) { return std::abs(value - iso) < room ? beside : value; };
  for (int k = 0; k < image.Size[2]; ++k)
  {
    for (int j = 0; j < image.Size[1]; ++j)
    {
      auto* row = static_cast<float*>(padded->GetScalarPointer(0, j, k));
      image.Values.Copy(
        (static_cast<std::ptrdiff_t>(k) * image.Size[1] + j) * image.Size[0], image.Size[0], row);
      std::transform(row, row + image.Size[0], row, clear);
    }
  }
  return padded;
}

IndexedSurface SurfaceOf(vtkPolyData* polyData, const Workspace& space)
{
  if (!polyData || polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() == 0)
  {
    Refuse("The initial surface has no polygons. Give a closed surface, or choose another "
           "Initialization.");
  }
  if (const std::string fault = FaultOfCells(polyData); !fault.empty())
  {
    Refuse("The initial surface ", fault);
  }
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(polyData);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  return ToWorkspace(Triangles(triangulate->GetOutput()), space);
}

IndexedSurface ClosedIsoSurface(const LevelImage& image, const SurfaceOptions& options)
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(PadByBackground(image, options));
  contour->SetValue(0, options.IsoValue - image.Base);
  contour->ComputeNormalsOff();
  contour->ComputeGradientsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  IndexedSurface surface = Triangles(contour->GetOutput());
  // VTK orients iso-surfaces towards low values.
  if (!options.ObjectIsBright)
  {
    FlipOrientation(surface);
  }
  return surface;
}
}

SurfaceStart StartOf(const SegmentationRequest& request, const Workspace& space,
  const std::vector<Point>& seeds, const LevelImage& image)
{
  vtkPolyData* given = request.InitialSurface;
  SurfaceStart start;
  switch (request.Settings.Initialization)
  {
    case InitializationType::Seeds:
      start.From = SurfaceStart::Kind::Seeds;
      start.Seeds = SeedsOf(given, space);
      start.Seeds.insert(start.Seeds.end(), seeds.begin(), seeds.end());
      break;
    case InitializationType::IsoSurface:
      start.From = SurfaceStart::Kind::IsoSurface;
      start.Surface = ClosedIsoSurface(image, request.Settings.Options);
      break;
    case InitializationType::InputSurface:
      start.From = SurfaceStart::Kind::Surface;
      start.Surface = SurfaceOf(given, space);
      break;
    case InitializationType::EnclosingIcosahedron:
      break;
  }
  return start;
}
}
