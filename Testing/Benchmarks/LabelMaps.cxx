// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelMaps.h"

#include "ForVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageMedian3D.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace volumic::bench
{
namespace
{

using support::LabelMap;

constexpr std::size_t LeastPart = 200;

vtkSmartPointer<vtkImageData> ReadImage(const std::string& file)
{
  const auto read = [&file](auto* reader)
  {
    if (!reader->CanReadFile(file.c_str()))
    {
      throw std::runtime_error(file + ": not a readable volume");
    }
    reader->SetFileName(file.c_str());
    reader->Update();
    return vtkSmartPointer<vtkImageData>(reader->GetOutput());
  };
  const std::string ending = file.size() > 4 ? file.substr(file.size() - 4) : "";
  const vtkSmartPointer<vtkImageData> image = ending == ".vti"
    ? read(vtkSmartPointer<vtkXMLImageDataReader>::New().GetPointer())
    : read(vtkSmartPointer<vtkNIFTIImageReader>::New().GetPointer());
  vtkDataArray* values = image->GetPointData()->GetScalars();
  if (!values || values->GetNumberOfComponents() != 1)
  {
    throw std::runtime_error(file + ": has no point scalars of one component");
  }
  return image;
}

/** The geometry of an image, without its directions. */
LabelMap EmptyMap(vtkImageData* image)
{
  LabelMap map;
  image->GetDimensions(map.Size.data());
  image->GetSpacing(map.Spacing.data());
  map.Values.resize(static_cast<std::size_t>(image->GetNumberOfPoints()));
  return map;
}

/** Gives the background to parts with few voxels. */
void DropSmallParts(LabelMap& map)
{
  const std::array<std::ptrdiff_t, 3> strides = { 1, map.Size[0],
    static_cast<std::ptrdiff_t>(map.Size[0]) * map.Size[1] };
  std::vector<char> seen(map.Values.size(), 0);
  std::vector<std::size_t> part;
  for (std::size_t seed = 0; seed < map.Values.size(); ++seed)
  {
    const std::int16_t label = map.Values[seed];
    if (label == 0 || seen[seed])
    {
      continue;
    }
    part.assign(1, seed);
    seen[seed] = 1;
    for (std::size_t done = 0; done < part.size(); ++done)
    {
      const std::size_t voxel = part[done];
      for (int a = 0; a < 3; ++a)
      {
        const auto place = static_cast<int>(voxel / strides[a] % map.Size[a]);
        for (const int side : { -1, 1 })
        {
          if (place + side >= 0 && place + side < map.Size[a])
          {
            const std::size_t other = voxel + side * strides[a];
            if (!seen[other] && map.Values[other] == label)
            {
              seen[other] = 1;
              part.push_back(other);
            }
          }
        }
      }
    }
    if (part.size() < LeastPart)
    {
      for (const std::size_t voxel : part)
      {
        map.Values[voxel] = 0;
      }
    }
  }
}

} // namespace

//------------------------------------------------------------------------------
LabelMap ReadLabelMap(const std::string& file)
{
  const vtkSmartPointer<vtkImageData> image = ReadImage(file);
  LabelMap map = EmptyMap(image);
  vtkDataArray* values = image->GetPointData()->GetScalars();
  for (std::size_t v = 0; v < map.Values.size(); ++v)
  {
    const double value = values->GetComponent(static_cast<vtkIdType>(v), 0);
    if (value != std::rint(value) || std::abs(value) > std::numeric_limits<std::int16_t>::max())
    {
      throw std::runtime_error(file + ": not a label map, a voxel is " + std::to_string(value));
    }
    map.Values[v] = static_cast<std::int16_t>(value);
  }
  return map;
}

LabelMap LabelsOfScan(const std::string& file, const std::vector<double>& thresholds)
{
  vtkNew<vtkImageMedian3D> median;
  median->SetInputData(ReadImage(file));
  median->SetKernelSize(3, 3, 3);
  median->Update();
  LabelMap map = EmptyMap(median->GetOutput());
  vtkDataArray* values = median->GetOutput()->GetPointData()->GetScalars();
  for (std::size_t v = 0; v < map.Values.size(); ++v)
  {
    const double value = values->GetComponent(static_cast<vtkIdType>(v), 0);
    map.Values[v] = static_cast<std::int16_t>(std::count_if(thresholds.begin(), thresholds.end(),
      [value](double threshold) { return value >= threshold; }));
  }
  DropSmallParts(map);
  return map;
}

LabelMap MaskOf(LabelMap map)
{
  for (std::int16_t& value : map.Values)
  {
    value = value > 0;
  }
  return map;
}

std::map<int, long long> CountLabels(const LabelMap& map)
{
  std::vector<long long> counts(1 << 16, 0);
  for (const std::int16_t value : map.Values)
  {
    ++counts[static_cast<std::size_t>(value + (1 << 15))];
  }
  std::map<int, long long> labels;
  for (int i = 0; i < (1 << 16); ++i)
  {
    const int label = i - (1 << 15);
    if (counts[i] > 0 && label != 0)
    {
      labels[label] = counts[i];
    }
  }
  return labels;
}

LabelMap CropToLabel(const LabelMap& map, int label, int margin)
{
  std::array<int, 3> from = map.Size, to = { -1, -1, -1 };
  std::size_t voxel = 0;
  ForVoxels(map.Size,
    [&](int i, int j, int k)
    {
      if (map.Values[voxel] == label)
      {
        from = { std::min(from[0], i), std::min(from[1], j), std::min(from[2], k) };
        to = { std::max(to[0], i), std::max(to[1], j), std::max(to[2], k) };
      }
      ++voxel;
    });
  if (to[0] < 0)
  {
    throw std::runtime_error("the map has no label " + std::to_string(label));
  }
  LabelMap crop;
  crop.Spacing = map.Spacing;
  for (int a = 0; a < 3; ++a)
  {
    from[a] -= margin;
    crop.Size[a] = to[a] + margin - from[a] + 1;
    crop.Origin[a] = map.Origin[a] + from[a] * map.Spacing[a];
  }
  crop.Values.resize(static_cast<std::size_t>(crop.Size[0]) * crop.Size[1] * crop.Size[2]);
  voxel = 0;
  const auto isIn = [&map](int a, int i) { return i >= 0 && i < map.Size[a]; };
  ForBox(from, { from[0] + crop.Size[0], from[1] + crop.Size[1], from[2] + crop.Size[2] },
    [&](int i, int j, int k)
    {
      if (isIn(0, i) && isIn(1, j) && isIn(2, k))
      {
        crop.Values[voxel] =
          map.Values[(static_cast<std::size_t>(k) * map.Size[1] + j) * map.Size[0] + i];
      }
      ++voxel;
    });
  return crop;
}

} // namespace volumic::bench
