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
#include <vtkImageInterpolator.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <vector>

namespace tool
{
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
    const int steps = normals ? static_cast<int>(std::ceil(this->Depth / step)) : 0;
    vtkNew<vtkImageInterpolator> interpolator;
    interpolator->SetTolerance(0.5); // out to the faces of the outer voxels
    interpolator->Initialize(image);
    const auto components = static_cast<std::size_t>(interpolator->GetNumberOfComponents());
    vtkNew<vtkDoubleArray> values;
    values->SetName(name.c_str());
    values->SetNumberOfComponents(static_cast<int>(components));
    values->SetNumberOfTuples(surface->GetNumberOfPoints());
    std::vector<double> found(components);
    for (vtkIdType point = 0; point < surface->GetNumberOfPoints(); ++point)
    {
      std::vector<double> sums(components, 0.0);
      int count = 0;
      for (int i = 0; i <= steps; ++i)
      {
        double place[3];
        double index[3];
        surface->GetPoint(point, place);
        for (int axis = 0; axis < 3 && i > 0; ++axis)
        {
          place[axis] -= this->Depth * i / steps * normals->GetComponent(point, axis);
        }
        image->TransformPhysicalPointToContinuousIndex(place, index);
        if (interpolator->CheckBoundsIJK(index))
        {
          interpolator->InterpolateIJK(index, found.data());
          std::transform(found.begin(), found.end(), sums.begin(), sums.begin(), std::plus<>());
          ++count;
        }
      }
      for (double& sum : sums)
      {
        sum = count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
      }
      values->SetTuple(point, sums.data());
    }
    surface->GetPointData()->AddArray(values);
  }
}
}
