// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabImage_h
#define volumicSlabImage_h

#include <vtkSmartPointer.h>

#include <array>
#include <vector>

class vtkDataArray;
class vtkImageData;

namespace volumic
{
/**
 * An image that is put together of slabs, or of any parts of its extent, in memory that may be
 * scratch memory. It gets the arrays of points that hold numbers, and the ghost array of the cells,
 * or all of their arrays; place, fields and active scalars are those of the first slab.
 */
class SlabImage
{
public:
  explicit SlabImage(const std::array<int, 6>& whole, bool withCells = false);

  /**
   * Copies what a slab has, which may be more slices than its neighbours need.
   * @throws std::invalid_argument if its arrays do not fit; ScratchFull, std::bad_alloc.
   */
  void Take(vtkImageData* slab);

  const std::array<int, 6>& GetExtent() const { return this->Extent; }

  /** Whether slabs must share slices, as what lies between two slices matters. */
  bool HasCells() const { return !this->Cells.empty(); }

  /** The slices so far, once all have been taken. */
  vtkSmartPointer<vtkImageData> Image() const { return this->Whole; }

private:
  /** Arrays of the whole, by their numbers in a slab; null where those are no numbers. */
  using Arrays = std::vector<vtkSmartPointer<vtkDataArray>>;
  void Begin(vtkImageData* slab);
  std::vector<vtkDataArray*> CellArraysOf(vtkImageData* slab) const;

  std::array<int, 6> Extent;
  bool WithCells;
  vtkSmartPointer<vtkImageData> Whole; ///< null before the first slab
  Arrays Points;
  Arrays Cells;
};
}

#endif
