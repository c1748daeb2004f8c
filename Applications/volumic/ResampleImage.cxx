// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ResampleImage.h"

#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkBoundingBox.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tool
{
namespace
{
/** Along an axis, for a pyramid to have a level. */
constexpr int LeastVoxels = 8;
/** Of a new image; more is an error of the order. */
constexpr double MostVoxels = 1e11;

/** The voxels of an image. */
struct GridFacts
{
  std::array<int, 3> Size = { 0, 0, 0 };
  Vector3 Spacing = { 1.0, 1.0, 1.0 };
};

GridFacts GridOf(vtkImageData* image)
{
  GridFacts grid;
  image->GetDimensions(grid.Size.data());
  image->GetSpacing(grid.Spacing.data());
  return grid;
}

std::string TextOf(const GridFacts& grid)
{
  std::string size;
  std::string spacing;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string between = axis == 0 ? "" : " x ";
    size += between + NumberText(grid.Size[axis]);
    spacing += between + NumberText(std::round(1e6 * grid.Spacing[axis]) / 1e6);
  }
  return size + " voxels of " + spacing;
}

int NewSize(int size, double spacing, double wanted)
{
  return std::max(1, static_cast<int>(std::lround(size * spacing / wanted)));
}

/** @return the spacing that is asked for; the image's own where nothing is. */
Vector3 WantedSpacing(const ToolOptions& options, const GridFacts& grid, bool areLabels)
{
  if (options.ResampledSpacing)
  {
    return *options.ResampledSpacing;
  }
  const double least = *std::min_element(grid.Spacing.begin(), grid.Spacing.end());
  Vector3 wanted = grid.Spacing;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = grid.Size[axis];
    const bool isThin = !areLabels && options.WantsSurface() && options.Edges.empty() &&
      options.Choice.Resamples && size > 1 && size < LeastVoxels;
    if (options.IsIsotropic)
    {
      wanted[axis] = least;
    }
    if (isThin && NewSize(size, grid.Spacing[axis], wanted[axis]) < LeastVoxels)
    {
      wanted[axis] = size * grid.Spacing[axis] / LeastVoxels;
    }
  }
  return wanted;
}
}

vtkSmartPointer<vtkImageData> Resampled(vtkImageData* image, const Vector3& spacing, bool areLabels)
{
  // Along the voxels' axes, from the outer face of the first voxel on: the place in the world is
  // set afterwards.
  int extent[6];
  int newExtent[6];
  double first[3];
  image->GetExtent(extent);
  const GridFacts grid = GridOf(image);
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = NewSize(grid.Size[axis], grid.Spacing[axis], spacing[axis]);
    newExtent[2 * axis] = 0;
    newExtent[2 * axis + 1] = size - 1;
    first[axis] = 0.5 * ((grid.Size[axis] - 1) * grid.Spacing[axis] - (size - 1) * spacing[axis]);
  }
  vtkNew<vtkImageData> plain;
  plain->SetDimensions(grid.Size.data());
  plain->SetSpacing(grid.Spacing.data());
  plain->GetPointData()->SetScalars(image->GetPointData()->GetScalars());
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(plain);
  reslice->SetOutputSpacing(spacing.data());
  reslice->SetOutputOrigin(first);
  reslice->SetOutputExtent(newExtent);
  reslice->BorderOn(); // Out to the faces of the outer voxels their values are taken.
  if (areLabels)
  {
    reslice->SetInterpolationModeToNearestNeighbor();
  }
  else
  {
    reslice->SetInterpolationModeToLinear();
    reslice->SetOutputScalarType(image->GetScalarType() == VTK_DOUBLE ? VTK_DOUBLE : VTK_FLOAT);
  }
  reslice->Update();
  auto made = vtkSmartPointer<vtkImageData>::New();
  made->ShallowCopy(reslice->GetOutput());
  made->GetPointData()->GetScalars()->SetName(image->GetPointData()->GetScalars()->GetName());
  double index[3];
  double origin[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    index[axis] = extent[2 * axis] + first[axis] / grid.Spacing[axis];
  }
  image->TransformContinuousIndexToPhysicalPoint(index, origin);
  made->SetOrigin(origin);
  made->SetDirectionMatrix(image->GetDirectionMatrix());
  made->GetFieldData()->ShallowCopy(image->GetFieldData());
  return made;
}

namespace
{
/** The voxels whose centres are in a box of the world, and those next to it; all that it touches.
 */
std::array<int, 6> ExtentOf(vtkImageData* image, const std::array<double, 6>& box)
{
  vtkBoundingBox indices;
  for (int corner = 0; corner < 8; ++corner)
  {
    double place[3];
    double index[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = box[2 * axis + (corner >> axis & 1)];
    }
    image->TransformPhysicalPointToContinuousIndex(place, index);
    indices.AddPoint(index);
  }
  std::array<int, 6> extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto whole = [](double index) { return static_cast<int>(std::clamp(index, -1e9, 1e9)); };
    extent[2 * axis] = whole(std::floor(indices.GetBound(2 * axis) + 1e-6));
    extent[2 * axis + 1] = whole(std::ceil(indices.GetBound(2 * axis + 1) - 1e-6));
  }
  return extent;
}
}

void CropAsAsked(const ToolOptions& options, vtkSmartPointer<vtkImageData>& image)
{
  if (!options.Region && !options.RegionBox)
  {
    return;
  }
  std::array<int, 6> wanted =
    options.Region ? *options.Region : ExtentOf(image, *options.RegionBox);
  const int* whole = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    int* range = &wanted[2 * axis];
    const std::string text = std::string(1, "ijk"[axis]) + " " + std::to_string(whole[2 * axis]) +
      " to " + std::to_string(whole[2 * axis + 1]);
    FailIf(range[0] > whole[2 * axis + 1] || range[1] < whole[2 * axis],
      options.Volume + ": the region lies beside the volume, which has voxels " + text);
    range[0] = std::max(range[0], whole[2 * axis]);
    range[1] = std::min(range[1], whole[2 * axis + 1]);
  }
  auto part = vtkSmartPointer<vtkImageData>::New();
  part->ShallowCopy(image);
  part->Crop(wanted.data());
  image = part;
}

void ResampleAsAsked(const ToolOptions& options, bool areLabels,
  vtkSmartPointer<vtkImageData>& image, const Announcer& announcer)
{
  const GridFacts before = GridOf(image);
  const Vector3 wanted = WantedSpacing(options, before, areLabels);
  if (wanted == before.Spacing)
  {
    return;
  }
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    voxels *= std::max(1.0, before.Size[axis] * before.Spacing[axis] / wanted[axis]);
  }
  FailIf(!(voxels < MostVoxels),
    options.Volume + ": resampled it would have " + NumberText(std::round(voxels)) + " voxels");
  image = Resampled(image, wanted, areLabels);
  const bool isAsked = options.ResampledSpacing || options.IsIsotropic;
  const std::string told = "resampled from " + TextOf(before) +
    (isAsked ? "" : ": a surface needs 8 voxels along each axis");
  const std::string earlier = GetFact(image, "Resampling");
  SetFact(image, "Resampling", (earlier.empty() ? "" : earlier + "; ") + told);
  announcer.Say(options.Volume + ": " + told);
}
}
