// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImageVoxels_h
#define volumicImageVoxels_h

#include "Core/Common/Executor.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <string>

class vtkImageData;
class vtkInformation;

/**
 * What the filters ask of an image before they believe it. Errors are std::invalid_argument with
 * a message that names the array and the way out.
 */

namespace volumic
{
/** The name of the array that a selection means; empty: none, as for the active scalars. */
std::string ChosenName(vtkInformation* selection);

/**
 * The array of voxels that was chosen: `selection` is GetInputArrayInformation(0) of the filter.
 * @throws if the image has no voxels, or there is no such array, or it is not numeric point data
 *         with a value for every voxel.
 */
vtkDataArray* ChooseArray(vtkInformation* selection, vtkImageData* image);

/**
 * The same, of one component.
 * @throws also if it has several.
 */
vtkDataArray* ChooseVoxels(vtkInformation* selection, vtkImageData* image);

/**
 * One component of an array: the array itself where it has no other; else a copy of that component,
 * of the same type, or, for component -1, the magnitude of all, as real numbers. The name is kept.
 * @throws if there is no such component.
 */
vtkSmartPointer<vtkDataArray> SelectComponent(vtkDataArray* array, int component);

/**
 * A copy of the image, whose arrays are shared, with these voxels as its active scalars: they take
 * the place of an array of their name.
 */
vtkSmartPointer<vtkImageData> WithVoxels(vtkImageData* image, vtkDataArray* voxels);

/** The same values plain and contiguous in memory: the array itself where it is one already. */
vtkSmartPointer<vtkDataArray> ContiguousVoxels(vtkDataArray* voxels);

/** Calls `work` with the voxels, contiguous in memory, in the type that they have. */
template <typename Work>
void VisitVoxels(vtkDataArray* voxels, const Work& work)
{
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(work(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0))));
  }
}

/**
 * Whether single precision keeps the differences of voxels of this range: rounding changes them by
 * less than 1e-5 of the range.
 */
bool FloatHolds(double smallest, double largest);

/** `array 'name'`, for messages. */
std::string NameOf(vtkDataArray* array);

/** `256 x 256 x 108`, for messages. */
std::string SizeOf(vtkImageData* image);

/** The values of an object that is neither all above nor all below one: Lower < image < Upper. */
struct ValueRange
{
  double Lower = 0.0;
  double Upper = std::numeric_limits<double>::infinity(); ///< infinite: Lower alone parts it

  bool IsUsed() const { return this->Upper != std::numeric_limits<double>::infinity(); }
  /** @throws std::invalid_argument naming Iso Value, Upper Value and what they are. */
  void Check() const;
};

/**
 * The voxels folded at the middle of the range, min(v, Lower + Upper - v): they are above Lower
 * where v is within the range, by min(v - Lower, Upper - v), so that Lower is the iso-value of the
 * object, and all that asks for voxels needs to know of no range. As float, or as double where the
 * type has more digits than float; of the same name.
 * @param voxels contiguous in memory, one component
 * @throws std::bad_alloc, ScratchFull.
 */
vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads);
}

#endif
