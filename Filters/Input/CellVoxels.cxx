// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/CellVoxels.h"

#include "Input/ImageVoxels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <string>

namespace volumic
{
namespace
{
/** The array of cells that is meant, if cells are. */
vtkDataArray* ChosenCells(vtkImageData* image, vtkInformation* selection)
{
  const std::string name = ChosenName(selection);
  if (!name.empty())
  {
    const bool areCells = selection->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
      selection->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    return areCells ? image->GetCellData()->GetArray(name.c_str()) : nullptr;
  }
  return image->GetPointData()->GetScalars() ? nullptr : image->GetCellData()->GetScalars();
}

/** Hides the points that stand for hidden cells. */
void BlankAsCells(vtkImageData* cells, vtkImageData* points)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    cells->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (!ghosts || ghosts->GetNumberOfTuples() != points->GetNumberOfPoints())
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> hidden;
  hidden->SetName(vtkDataSetAttributes::GhostArrayName());
  hidden->SetNumberOfTuples(ghosts->GetNumberOfTuples());
  std::transform(ghosts->GetPointer(0), ghosts->GetPointer(0) + ghosts->GetNumberOfTuples(),
    hidden->GetPointer(0),
    [](unsigned char ghost)
    {
      return static_cast<unsigned char>(
        ghost & vtkDataSetAttributes::HIDDENCELL ? vtkDataSetAttributes::HIDDENPOINT : 0);
    });
  points->GetPointData()->AddArray(hidden);
}
}

PointVoxels TakeCellsAsPoints(vtkImageData* image, vtkInformation* selection)
{
  PointVoxels voxels;
  vtkDataArray* cells = image ? ChosenCells(image, selection) : nullptr;
  if (!cells)
  {
    voxels.Image = image;
    voxels.Selection = selection;
    return voxels;
  }
  voxels.Image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  double first[3];
  double centre[3];
  image->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis with one point has one cell.
    extent[2 * axis + 1] = std::max(extent[2 * axis], extent[2 * axis + 1] - 1);
    first[axis] = image->GetDimensions()[axis] > 1 ? 0.5 : 0.0;
  }
  image->TransformContinuousIndexToPhysicalPoint(first, centre);
  voxels.Image->SetExtent(extent);
  voxels.Image->SetOrigin(centre);
  voxels.Image->SetSpacing(image->GetSpacing());
  voxels.Image->SetDirectionMatrix(image->GetDirectionMatrix());
  voxels.Image->GetPointData()->SetScalars(cells);
  BlankAsCells(image, voxels.Image);
  voxels.Selection = vtkSmartPointer<vtkInformation>::New();
  voxels.Selection->Set(
    vtkDataObject::FIELD_ASSOCIATION(), vtkDataObject::FIELD_ASSOCIATION_POINTS);
  voxels.Selection->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
  return voxels;
}
}
