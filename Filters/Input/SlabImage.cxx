// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/SlabImage.h"

#include "Core/Common/Refuse.h"
#include "Host/LargeArray.h"
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
#include <cstring>

namespace volumic
{
namespace
{
/** Copies all tuples to where they belong. */
void CopyTuples(vtkDataArray* from, vtkDataArray* to, vtkIdType first)
{
  const auto bytes = static_cast<std::size_t>(from->GetNumberOfComponents()) *
    static_cast<std::size_t>(from->GetDataTypeSize());
  std::memcpy(static_cast<char*>(to->GetVoidPointer(0)) + static_cast<std::size_t>(first) * bytes,
    from->GetVoidPointer(0), static_cast<std::size_t>(from->GetNumberOfTuples()) * bytes);
}

/** The numbers of a point array of a slab, contiguous in memory; null where they are no numbers. */
vtkSmartPointer<vtkDataArray> NumbersOf(vtkImageData* slab, int number)
{
  vtkDataArray* array = slab->GetPointData()->GetArray(number);
  return array && array->GetNumberOfTuples() == slab->GetNumberOfPoints()
    ? ContiguousVoxels(array)
    : nullptr;
}

vtkDataArray* CellGhostsOf(vtkImageData* slab)
{
  vtkDataArray* ghosts =
    slab->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName());
  return ghosts && ghosts->GetDataType() == VTK_UNSIGNED_CHAR &&
      ghosts->GetNumberOfTuples() == slab->GetNumberOfCells()
    ? ghosts
    : nullptr;
}

bool AreAlike(vtkDataArray* a, vtkDataArray* b)
{
  return !a == !b &&
    (!a || (a->GetDataType() == b->GetDataType() &&
             a->GetNumberOfComponents() == b->GetNumberOfComponents()));
}

vtkIdType Points(int first, int last)
{
  return last - first + 1;
}

/** Cells of so many points along an axis. */
vtkIdType Cells(int first, int last)
{
  return std::max(1, last - first);
}
}

SlabImage::SlabImage(const std::array<int, 6>& whole) : Extent(whole)
{
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
  const vtkIdType points = Points(e[0], e[1]) * Points(e[2], e[3]) * Points(e[4], e[5]);
  vtkDataArray* scalars = slab->GetPointData()->GetScalars();
  for (int i = 0; i < slab->GetPointData()->GetNumberOfArrays(); ++i)
  {
    const vtkSmartPointer<vtkDataArray> numbers = NumbersOf(slab, i);
    this->Arrays.emplace_back(numbers ? NewLargeArrayLike(numbers, points) : nullptr);
    if (numbers)
    {
      this->Arrays.back()->SetName(slab->GetPointData()->GetArray(i)->GetName());
      const int place = this->Whole->GetPointData()->AddArray(this->Arrays.back());
      if (slab->GetPointData()->GetArray(i) == scalars)
      {
        this->Whole->GetPointData()->SetActiveAttribute(place, vtkDataSetAttributes::SCALARS);
      }
    }
  }
  if (vtkDataArray* ghosts = CellGhostsOf(slab))
  {
    const vtkIdType cells = Cells(e[0], e[1]) * Cells(e[2], e[3]) * Cells(e[4], e[5]);
    this->CellGhosts = NewLargeArrayLike(ghosts, cells);
    this->Whole->GetCellData()->AddArray(this->CellGhosts);
  }
}

void SlabImage::Take(vtkImageData* slab)
{
  if (!this->Whole)
  {
    this->Begin(slab);
  }
  const std::array<int, 6>& whole = this->Extent;
  const int* has = slab->GetExtent();
  if (!std::equal(has, has + 4, whole.begin()) || has[4] < whole[4] || has[5] > whole[5])
  {
    const auto text = [](const int* e)
    { return Join(e[0], " to ", e[1], ", ", e[2], " to ", e[3], ", ", e[4], " to ", e[5]); };
    Refuse("the source of the image gave voxels ", text(has), "; it had told of ",
      text(whole.data()), ".");
  }
  const bool fits =
    slab->GetPointData()->GetNumberOfArrays() == static_cast<int>(this->Arrays.size());
  for (std::size_t i = 0; fits && i < this->Arrays.size(); ++i)
  {
    const vtkSmartPointer<vtkDataArray> numbers = NumbersOf(slab, static_cast<int>(i));
    if (!AreAlike(numbers, this->Arrays[i]))
    {
      Refuse("array ", i, " of the slices ", has[4], " to ", has[5], " is missing, or of another "
        "type than in the slices before them.");
    }
    if (numbers)
    {
      CopyTuples(numbers, this->Arrays[i],
        (has[4] - whole[4]) * Points(whole[0], whole[1]) * Points(whole[2], whole[3]));
    }
  }
  vtkDataArray* ghosts = CellGhostsOf(slab);
  if (!fits || !ghosts != !this->CellGhosts)
  {
    Refuse("the slices ", has[4], " to ", has[5], " have other arrays than those before them.");
  }
  // A slab of one slice has a cell of no height, which belongs to no two slices.
  if (ghosts && (has[5] > has[4] || whole[5] == whole[4]))
  {
    CopyTuples(ghosts, this->CellGhosts,
      (has[4] - whole[4]) * Cells(whole[0], whole[1]) * Cells(whole[2], whole[3]));
  }
}
}
