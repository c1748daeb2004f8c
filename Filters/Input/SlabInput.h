// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabInput_h
#define volumicSlabInput_h

#include <vtkSmartPointer.h>

#include <cstddef>
#include <functional>
#include <string>

class vtkAlgorithm;
class vtkImageData;
class vtkInformation;

namespace volumic
{
/**
 * The image at input port 0 of a filter with a limited memory. It is asked for slab by slab, each a
 * few slices along z, by the update extents of the pipeline, and put together in scratch memory: of
 * what comes before the filter, no more than a slab is in memory.
 *
 * The slabs are asked for within RequestData. The pipeline's own way, CONTINUE_EXECUTING, never
 * ends where a source fails at a later slab.
 */
class SlabInput
{
public:
  /** What is wanted of the image. */
  struct Request
  {
    std::size_t Limit = 0; ///< of the memory, bytes: what the size of a slab goes by
    vtkInformation* Selection = nullptr; ///< of the voxels, as GetInputArrayInformation()
    int SelectedComponent = -1;          ///< of the voxels (SelectComponent in ImageVoxels.h)
    bool TakesCells = false; ///< Cells become points, each slab by TakeCellsAsPoints().
    /** Told the share that is there; false asks to stop. */
    std::function<bool(double share)> GoOn;
  };

  /** The image, and how it came. */
  struct Result
  {
    /**
     * With the arrays of points that hold numbers, the ghost array of the cells, and the fields of
     * the first slab; the voxels are its active scalars, of one component. Null after a stop, and
     * where the image came as a whole and stays with its owner: then it is the input itself.
     */
    vtkSmartPointer<vtkImageData> Image;
    vtkSmartPointer<vtkInformation> Selection; ///< of the voxels in it
    bool IsStopped = false;
  };

  /** The filter that it is an input of. */
  explicit SlabInput(vtkAlgorithm* filter) : Filter(filter) {}

  /**
   * Whether what comes is an image whose sources can all give a part of it.
   * @param refusing the class of the first that cannot, where that is why
   */
  bool ComesInSlabs(std::string* refusing = nullptr) const;

  /**
   * In RequestUpdateExtent, where the memory is limited: asks for the first slab if the image comes
   * in slabs; where the run needs no voxels, as it goes on from a former one, for what is there.
   */
  void Ask(std::size_t limit, bool needsVoxels) const;

  /** What to tell, once, of an image that does not come in slabs; else empty. */
  std::string DescribeWhole() const;

  /**
   * In RequestData, where the first slab has come.
   * @throws std::invalid_argument where a slab does not come, or does not fit the ones before it;
   *         ScratchFull.
   */
  Result Read(const Request& request) const;

private:
  vtkInformation* Info() const;
  vtkImageData* Pull(int first, int last) const;

  vtkAlgorithm* Filter;
};
}

#endif
