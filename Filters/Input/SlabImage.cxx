// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/SlabImage.h"

#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelBox.h"
#include "Input/ImageVoxels.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace volumic
{
namespace
{
using Extent = std::array<int, 6>;

/** A slab of one slice has a cell of no height, which belongs to no two slices. */
bool IsBetween(const int* slab, const Extent& whole, int axis)
{
  return slab[2 * axis + 1] > slab[2 * axis] || whole[2 * axis + 1] == whole[2 * axis];
}

vtkSmartPointer<vtkDataArray> ArrayLike(vtkDataArray* like, vtkIdType tuples)
{
  vtkSmartPointer<vtkDataArray> array;
  array.TakeReference(vtkDataArray::CreateDataArray(like->GetDataType()));
  array->SetNumberOfComponents(like->GetNumberOfComponents());
  array->SetNumberOfTuples(tuples);
  return array;
}

/** Copies the tuples of a part to where they belong; of points, or of the cells between them. */
void CopyTuples(
  vtkDataArray* from, const int* slab, vtkDataArray* to, const Extent& whole, int less)
{
  const auto bytes = static_cast<std::size_t>(from->GetNumberOfComponents()) *
    static_cast<std::size_t>(from->GetDataTypeSize());
  VoxelBox part;
  VoxelBox all;
  for (int axis = 0; axis < 3; ++axis)
  {
    part.First[axis] = slab[2 * axis];
    part.End[axis] = slab[2 * axis] + std::max(1, slab[2 * axis + 1] - slab[2 * axis] + 1 - less);
    all.First[axis] = whole[2 * axis];
    all.End[axis] = whole[2 * axis] + std::max(1, whole[2 * axis + 1] - whole[2 * axis] + 1 - less);
  }
  const char* row = static_cast<const char*>(from->GetVoidPointer(0));
  char* begin = static_cast<char*>(to->GetVoidPointer(0));
  ForRowsOf(part, all,
    [&](std::int64_t first, std::int64_t count)
    {
      const std::size_t length = static_cast<std::size_t>(count) * bytes;
      std::memcpy(begin + static_cast<std::size_t>(first) * bytes, row, length);
      row += length;
    });
}

vtkIdType Count(const Extent& whole, int less)
{
  vtkIdType count = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    count *= std::max(1, whole[2 * axis + 1] - whole[2 * axis] + 1 - less);
  }
  return count;
}

/** The numbers of an array, contiguous in memory; null where they are none, or not enough. */
vtkSmartPointer<vtkDataArray> NumbersOf(vtkAbstractArray* array, vtkIdType count)
{
  auto* numbers = vtkDataArray::SafeDownCast(array);
  return numbers && numbers->GetNumberOfTuples() == count ? ContiguousVoxels(numbers) : nullptr;
}

vtkDataArray* CellGhostsOf(vtkImageData* slab)
{
  vtkDataArray* ghosts = slab->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName());
  return ghosts && ghosts->GetDataType() == VTK_UNSIGNED_CHAR &&
      ghosts->GetNumberOfTuples() == slab->GetNumberOfCells()
    ? ghosts
    : nullptr;
}

std::string NameIn(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

bool AreAlike(vtkDataArray* a, vtkDataArray* b)
{
  return !a == !b &&
    (!a ||
      (a->GetDataType() == b->GetDataType() && NameIn(a) == NameIn(b) &&
        a->GetNumberOfComponents() == b->GetNumberOfComponents()));
}
}

SlabImage::SlabImage(const std::array<int, 6>& whole, bool withCells)
  : Extent(whole), WithCells(withCells)
{
}

std::vector<vtkDataArray*> SlabImage::CellArraysOf(vtkImageData* slab) const
{
  std::vector<vtkDataArray*> arrays;
  for (int i = 0; this->WithCells && i < slab->GetCellData()->GetNumberOfArrays(); ++i)
  {
    arrays.push_back(slab->GetCellData()->GetArray(i));
  }
  if (vtkDataArray* ghosts = this->WithCells ? nullptr : CellGhostsOf(slab))
  {
    arrays.push_back(ghosts);
  }
  return arrays;
}

void SlabImage::Begin(vtkImageData* slab)
{
  const std::array<int, 6>& e = this->Extent;
  this->Whole = vtkSmartPointer<vtkImageData>::New();
  this->Whole->SetExtent(e[0], e[1], e[2], e[3], e[4], e[5]);
  this->Whole->SetOrigin(slab->GetOrigin());
  this->Whole->SetSpacing(slab->GetSpacing());
  this->Whole->SetDirectionMatrix(slab->GetDirectionMatrix());
  this->Whole->GetFieldData()->ShallowCopy(slab->GetFieldData());
  const auto add = [](vtkAbstractArray* array, vtkIdType ofSlab, vtkIdType ofWhole,
                     vtkDataArray* scalars, vtkDataSetAttributes* attributes, Arrays& arrays)
  {
    const vtkSmartPointer<vtkDataArray> numbers = NumbersOf(array, ofSlab);
    arrays.emplace_back(numbers ? ArrayLike(numbers, ofWhole) : nullptr);
    if (numbers)
    {
      arrays.back()->SetName(array->GetName());
      const int place = attributes->AddArray(arrays.back());
      if (array == scalars)
      {
        attributes->SetActiveAttribute(place, vtkDataSetAttributes::SCALARS);
      }
    }
  };
  for (int i = 0; i < slab->GetPointData()->GetNumberOfArrays(); ++i)
  {
    add(slab->GetPointData()->GetAbstractArray(i), slab->GetNumberOfPoints(), Count(e, 0),
      slab->GetPointData()->GetScalars(), this->Whole->GetPointData(), this->Points);
  }
  for (vtkDataArray* array : this->CellArraysOf(slab))
  {
    add(array, slab->GetNumberOfCells(), Count(e, 1), slab->GetCellData()->GetScalars(),
      this->Whole->GetCellData(), this->Cells);
  }
}

void SlabImage::Take(vtkImageData* slab)
{
  if (!this->Whole)
  {
    this->Begin(slab);
  }
  const int* has = slab->GetExtent();
  const std::vector<vtkDataArray*> cells = this->CellArraysOf(slab);
  if (slab->GetPointData()->GetNumberOfArrays() != static_cast<int>(this->Points.size()) ||
    cells.size() != this->Cells.size())
  {
    Refuse("the slices ", has[4], " to ", has[5], " have other arrays than those before them.");
  }
  const auto copy = [&](vtkAbstractArray* array, vtkIdType count, vtkDataArray* to, int less)
  {
    const vtkSmartPointer<vtkDataArray> numbers = NumbersOf(array, count);
    if (!AreAlike(numbers, to))
    {
      Refuse("an array of the slices ", has[4], " to ", has[5],
        " is missing, or of another name "
        "or type than in the slices before them.");
    }
    if (numbers)
    {
      CopyTuples(numbers, has, to, this->Extent, less);
    }
  };
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    copy(slab->GetPointData()->GetAbstractArray(static_cast<int>(i)), slab->GetNumberOfPoints(),
      this->Points[i], 0);
  }
  for (std::size_t i = 0; i < cells.size() && IsBetween(has, this->Extent, 0) &&
       IsBetween(has, this->Extent, 1) && IsBetween(has, this->Extent, 2);
       ++i)
  {
    copy(cells[i], slab->GetNumberOfCells(), this->Cells[i], 1);
  }
}
}
