// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFacts.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tool
{
namespace
{
using Bytes = std::array<unsigned char, 3>;

Bytes AsBytes(const Vector3& color)
{
  Bytes bytes;
  std::transform(color.begin(), color.end(), bytes.begin(),
    [](double part)
    { return static_cast<unsigned char>(std::lround(255.0 * std::clamp(part, 0.0, 1.0))); });
  return bytes;
}
}

std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason && reason->GetNumberOfValues() > 0 ? reason->GetValue(0) : "";
}

std::vector<SurfaceLabel> LabelsOf(vtkPolyData* surface)
{
  vtkFieldData* fields = surface->GetFieldData();
  vtkDataArray* numbers = fields->GetArray("Label");
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelName"));
  vtkDataArray* colors = fields->GetArray("LabelColor");
  std::vector<SurfaceLabel> labels;
  for (vtkIdType i = 0; numbers && names && colors && i < numbers->GetNumberOfTuples(); ++i)
  {
    SurfaceLabel label{ static_cast<int>(numbers->GetComponent(i, 0)), names->GetValue(i) };
    colors->GetTuple(i, label.Color.data());
    labels.push_back(label);
  }
  return labels;
}

const int* TriangleLabels(vtkPolyData* surface)
{
  auto* labels = vtkIntArray::SafeDownCast(surface->GetCellData()->GetArray("Label"));
  return labels ? labels->GetPointer(0) : nullptr;
}

vtkSmartPointer<vtkUnsignedCharArray> VertexColors(vtkPolyData* surface)
{
  const int* labels = TriangleLabels(surface);
  std::map<int, Bytes> colors;
  for (const SurfaceLabel& label : LabelsOf(surface))
  {
    colors[label.Label] = AsBytes(label.Color);
  }
  if (!labels || colors.empty())
  {
    return nullptr;
  }
  auto vertices = vtkSmartPointer<vtkUnsignedCharArray>::New();
  vertices->SetName("Color");
  vertices->SetNumberOfComponents(3);
  vertices->SetNumberOfTuples(surface->GetNumberOfPoints());
  vertices->FillValue(0);
  std::vector<bool> isColored(static_cast<std::size_t>(surface->GetNumberOfPoints()), false);
  ForEachPolygon(surface,
    [&](vtkIdType polygon, const vtkIdType* corners, vtkIdType count)
    {
      const Bytes& color = colors[labels[polygon]];
      for (vtkIdType c = 0; c < count; ++c)
      {
        if (!isColored[static_cast<std::size_t>(corners[c])])
        {
          isColored[static_cast<std::size_t>(corners[c])] = true;
          vertices->SetTypedTuple(corners[c], color.data());
        }
      }
    });
  return vertices;
}

// ---- Sizes --------------------------------------------------------------------------------------

SurfaceSize SizeOf(vtkPolyData* surface)
{
  return surface ? SurfaceSize{ surface->GetNumberOfPoints(), surface->GetNumberOfPolys() }
                 : SurfaceSize();
}

std::vector<SurfaceSize> SizesOf(vtkMultiBlockDataSet* blocks)
{
  std::vector<SurfaceSize> sizes;
  for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
  {
    sizes.push_back(SizeOf(vtkPolyData::SafeDownCast(blocks->GetBlock(i))));
  }
  return sizes;
}
}
