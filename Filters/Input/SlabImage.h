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
 * An image that is put together of slabs, parts with all of its voxels along x and y, in memory
 * that may be scratch memory. It gets the arrays of points that hold numbers, and the ghost array
 * of the cells; place, fields and active scalars are those of the first slab.
 */
class SlabImage
{
public:
  explicit SlabImage(const std::array<int, 6>& whole);

  /**
   * Copies what a slab has, also where it has more slices than its neighbours need.
   * @throws std::invalid_argument if its size or arrays do not fit; ScratchFull, std::bad_alloc.
   */
  void Take(vtkImageData* slab);

  /** Whether slabs must share slices, as what lies between two slices matters. */
  bool HasCells() const { return this->CellGhosts != nullptr; }

  /** The slices so far, once all have been taken. */
  vtkSmartPointer<vtkImageData> Image() const { return this->Whole; }

private:
  void Begin(vtkImageData* slab);

  std::array<int, 6> Extent;
  vtkSmartPointer<vtkImageData> Whole; ///< null before the first slab
  std::vector<vtkSmartPointer<vtkDataArray>> Arrays; ///< of the whole, by their numbers in a slab
  vtkSmartPointer<vtkDataArray> CellGhosts;          ///< or null
};
}

#endif
