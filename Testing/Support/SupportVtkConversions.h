// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
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
#include <vtkImageCast.h>
#include <vtkImageConstantPad.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

/** Conversions to and from VTK. Inline: the support library does not depend on VTK. */
namespace volumic::support
{
/** Return an image with the size, spacing and values of a volume. */
template <typename Array, typename Volume>
vtkSmartPointer<vtkImageData> ToImageOf(const Volume& volume, const char* name)
{
  vtkNew<Array> values;
  values->SetName(name);
  values->SetNumberOfTuples(static_cast<vtkIdType>(volume.Values.size()));
  std::copy(volume.Values.begin(), volume.Values.end(), values->GetPointer(0));
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.Size.data());
  image->SetSpacing(volume.Spacing.data());
  image->GetPointData()->SetScalars(values);
  return image;
}

/** Return an image with origin 0 and point scalars `Scene`. */
inline vtkSmartPointer<vtkImageData> ToImage(const Scene& scene)
{
  return ToImageOf<vtkFloatArray>(scene, "Scene");
}

/** Return an image with point scalars `Labels`. */
inline vtkSmartPointer<vtkImageData> ToImage(const LabelMap& map)
{
  return ToImageOf<vtkShortArray>(map, "Labels");
}

/**
 * Return the triangles of a surface. With an image, points are in its index coordinates, relative
 * to its extent. Throw std::invalid_argument if a polygon is not a triangle or a coordinate is not
 * finite.
 */
inline TriangleSurface ToTriangleSurface(vtkPolyData* polyData, vtkImageData* image = nullptr)
{
  TriangleSurface surface;
  const vtkIdType numberOfPoints = polyData->GetNumberOfPoints();
  surface.Points.resize(static_cast<std::size_t>(numberOfPoints));
  for (vtkIdType p = 0; p < numberOfPoints; ++p)
  {
    double* point = surface.Points[static_cast<std::size_t>(p)].data();
    polyData->GetPoint(p, point);
    if (!std::isfinite(point[0] + point[1] + point[2]))
    {
      throw std::invalid_argument("ToTriangleSurface: a coordinate is not finite");
    }
    if (image)
    {
      double index[3];
      image->TransformPhysicalPointToContinuousIndex(point, index);
      for (int a = 0; a < 3; ++a)
      {
        point[a] = index[a] - image->GetExtent()[2 * a];
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

/** Return delta of each point, world units, from `EdgeSize` or `Delta`; empty without both. */
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

/** Return the image with a border of one voxel that has its least value. */
inline vtkSmartPointer<vtkImageData> Padded(vtkImageData* image)
{
  const int* extent = image->GetExtent();
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputData(image);
  pad->SetConstant(image->GetScalarRange()[0]);
  pad->SetOutputWholeExtent(
    extent[0] - 1, extent[1] + 1, extent[2] - 1, extent[3] + 1, extent[4] - 1, extent[5] + 1);
  pad->Update();
  return pad->GetOutput();
}

/** Convert the voxels to float and return them for the judge. The image must outlive the volume. */
inline JudgedVolume ToJudgedVolume(vtkImageData* image, double isoValue)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(image);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  image->GetPointData()->SetScalars(cast->GetOutput()->GetPointData()->GetScalars());
  JudgedVolume volume;
  volume.Values = static_cast<const float*>(image->GetScalarPointer());
  image->GetDimensions(volume.Size.data());
  volume.IsoValue = isoValue;
  return volume;
}

/** Return the volume of a scene for the judge. The scene must outlive it. */
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
