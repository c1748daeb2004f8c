// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProbeVolumes.h"

#include "LoadInputs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "WorldSpace.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace tool
{
namespace
{
/** Adds the values at a place of the world. @return whether the image reaches there */
bool AddValues(vtkImageData* image, const double* place, std::vector<double>& sums)
{
  double index[3];
  image->TransformPhysicalPointToContinuousIndex(place, index);
  const int* extent = image->GetExtent();
  int first[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double outside = 0.5; // out to the faces of the outer voxels
    if (!(index[axis] >= extent[2 * axis] - outside && index[axis] <= extent[2 * axis + 1] + outside))
    {
      return false;
    }
    const double inside =
      std::clamp<double>(index[axis], extent[2 * axis], extent[2 * axis + 1]);
    first[axis] =
      std::clamp(static_cast<int>(inside), extent[2 * axis], std::max(extent[2 * axis], extent[2 * axis + 1] - 1));
    share[axis] = inside - first[axis];
  }
  vtkDataArray* values = image->GetPointData()->GetScalars();
  for (int corner = 0; corner < 8; ++corner)
  {
    int at[3];
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool isNext = (corner >> axis & 1) != 0;
      at[axis] = first[axis] + (isNext ? 1 : 0);
      weight *= isNext ? share[axis] : 1.0 - share[axis];
    }
    for (int c = 0; weight > 0.0 && c < values->GetNumberOfComponents(); ++c)
    {
      sums[static_cast<std::size_t>(c)] +=
        weight * values->GetComponent(image->ComputePointId(at), c);
    }
  }
  return true;
}
}

ProbeVolumes::ProbeVolumes(const ToolOptions& options, const Announcer& announcer)
  : Depth(options.ProbeDepth)
{
  DistinctNames names("-");
  for (const std::string& file : options.Probes)
  {
    const auto image = LoadWhole(file, "", VolumeChoice(), announcer);
    WorldChoice world = options.World;
    world.Spacing.reset();
    Named(file, [&] { PlaceInWorld(image, world); });
    std::string name = std::filesystem::path(file).filename().string();
    name = name.substr(0, std::max<std::size_t>(name.find('.'), 1));
    this->Volumes.emplace_back(names.Take(name), image);
  }
}

void ProbeVolumes::AddTo(vtkPolyData* surface) const
{
  for (const auto& [name, image] : this->Volumes)
  {
    vtkDataArray* normals = surface->GetPointData()->GetNormals();
    const double* spacing = image->GetSpacing();
    const double step = 0.5 * *std::min_element(spacing, spacing + 3);
    const int steps = static_cast<int>(std::ceil(this->Depth / step));
    const int components = image->GetPointData()->GetScalars()->GetNumberOfComponents();
    vtkNew<vtkDoubleArray> values;
    values->SetName(name.c_str());
    values->SetNumberOfComponents(components);
    values->SetNumberOfTuples(surface->GetNumberOfPoints());
    for (vtkIdType point = 0; point < surface->GetNumberOfPoints(); ++point)
    {
      std::vector<double> sums(static_cast<std::size_t>(components), 0.0);
      int count = 0;
      for (int i = 0; i <= steps; ++i)
      {
        double place[3];
        surface->GetPoint(point, place);
        for (int axis = 0; axis < 3 && i > 0 && normals; ++axis)
        {
          place[axis] -= this->Depth * i / steps * normals->GetComponent(point, axis);
        }
        count += AddValues(image, place, sums) ? 1 : 0;
      }
      for (int c = 0; c < components; ++c)
      {
        values->SetComponent(point, c,
          count > 0 ? sums[static_cast<std::size_t>(c)] / count
                    : std::numeric_limits<double>::quiet_NaN());
      }
    }
    surface->GetPointData()->AddArray(values);
  }
}
}
