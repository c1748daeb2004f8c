// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Scenes, label maps and surfaces to and from VTK. Inline, so that the support library itself needs
 * no VTK; who includes it links VTK::CommonCore, VTK::CommonDataModel.
 */

#ifndef volumicSupportVtkConversions_h
#define volumicSupportVtkConversions_h

#include "LabelShapes.h"
#include "SurfaceJudge.h"
#include "SyntheticScenes.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace volumic::support
{

/** The scene with its spacing, origin 0, and the values as float point scalars named `Scene`. */
inline vtkSmartPointer<vtkImageData> ToImage(const Scene& scene)
{
  vtkNew<vtkFloatArray> values;
  values->SetName("Scene");
  values->SetNumberOfTuples(static_cast<vtkIdType>(scene.Values.size()));
  std::copy(scene.Values.begin(), scene.Values.end(), values->GetPointer(0));
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(scene.Size[0], scene.Size[1], scene.Size[2]);
  image->SetSpacing(scene.Spacing[0], scene.Spacing[1], scene.Spacing[2]);
  image->GetPointData()->SetScalars(values);
  return image;
}

/** With its values as point scalars `Labels`. */
inline vtkSmartPointer<vtkImageData> ToImage(const LabelMap& map)
{
  vtkNew<vtkShortArray> values;
  values->SetName("Labels");
  values->SetNumberOfTuples(static_cast<vtkIdType>(map.Values.size()));
  std::copy(map.Values.begin(), map.Values.end(), values->GetPointer(0));
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(map.Size.data());
  image->SetSpacing(map.Spacing.data());
  image->SetOrigin(map.Origin.data());
  image->GetPointData()->SetScalars(values);
  return image;
}

/**
 * The polygons of a poly data. With an image, points are taken to its index coordinates (voxel
 * (0, 0, 0) of its extent at the origin). Throws std::invalid_argument unless all polygons are
 * triangles.
 */
inline TriangleSurface ToTriangleSurface(vtkPolyData* polyData, vtkImageData* image = nullptr)
{
  TriangleSurface surface;
  const vtkIdType numberOfPoints = polyData->GetNumberOfPoints();
  surface.Points.resize(static_cast<std::size_t>(numberOfPoints));
  for (vtkIdType p = 0; p < numberOfPoints; ++p)
  {
    double* place = surface.Points[static_cast<std::size_t>(p)].data();
    polyData->GetPoint(p, place);
    if (image)
    {
      double index[3];
      image->TransformPhysicalPointToContinuousIndex(place, index);
      for (int a = 0; a < 3; ++a)
      {
        place[a] = index[a] - image->GetExtent()[2 * a];
      }
    }
  }
  auto cells = vtk::TakeSmartPointer(polyData->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* corners;
    cells->GetCurrentCell(size, corners);
    if (size != 3)
    {
      throw std::invalid_argument("ToTriangleSurface: a polygon is not a triangle");
    }
    surface.Triangles.push_back(
      { static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2]) });
  }
  return surface;
}

/**
 * The delta of each point, world units: from `EdgeSize` where the surface is graded, else that of
 * the whole surface; none where nothing tells of any.
 */
inline std::vector<double> DeltasOf(vtkPolyData* surface)
{
  constexpr double requestedInDelta = 1.6; // Edges may be 1 to 2.5.
  std::vector<double> deltas;
  vtkDataArray* sizes = surface->GetPointData()->GetArray("EdgeSize");
  vtkDataArray* delta = surface->GetFieldData()->GetArray("Delta");
  for (vtkIdType p = 0; (sizes || delta) && p < surface->GetNumberOfPoints(); ++p)
  {
    deltas.push_back(
      sizes ? sizes->GetComponent(p, 0) / requestedInDelta : delta->GetComponent(0, 0));
  }
  return deltas;
}

/** What the judge takes for a scene. The scene has to stay alive. */
inline JudgedVolume ToJudgedVolume(const Scene& scene)
{
  JudgedVolume volume;
  volume.Values = scene.Values.data();
  volume.Size = scene.Size;
  volume.IsoValue = scene.IsoValue;
  volume.ObjectIsBright = scene.ObjectIsBright;
  return volume;
}

} // namespace volumic::support

#endif
