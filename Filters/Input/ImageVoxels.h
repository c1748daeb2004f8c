// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImageVoxels_h
#define volumicImageVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <string>

class vtkImageData;
class vtkInformation;

// Arrays of images as voxels. Errors are a Refusal naming the array and how to fix it.

namespace volumic
{
/** Return the name of the selected array; empty: none, as for the active scalars. */
std::string ChosenName(vtkInformation* selection);

/**
 * Return the selected array of voxels.
 * @param selection GetInputArrayInformation(0) of the filter
 * @throws Refusal if it is not numeric point data with a value for every voxel
 */
vtkDataArray* ChooseArray(vtkInformation* selection, vtkImageData* image);

/** The same. @throws Refusal also if it has several components */
vtkDataArray* ChooseVoxels(vtkInformation* selection, vtkImageData* image);

/**
 * Return the array itself if it has one component. Else return a copy of a component, or, for -1,
 * the magnitude of all as real numbers, with the same name.
 * @throws Refusal if there is no such component
 */
vtkSmartPointer<vtkDataArray> SelectComponent(vtkDataArray* array, int component);

/** Return a shallow copy with these active scalars, which replace an array of the same name. */
vtkSmartPointer<vtkImageData> WithVoxels(vtkImageData* image, vtkDataArray* voxels);

/** Return the values contiguous in memory: the array itself if it is contiguous. */
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

/** Return whether rounding to float changes differences by less than 1e-5 of the range. */
bool FitsFloat(double smallest, double largest);

/** `array 'name'`, for messages. */
std::string NameOf(vtkDataArray* array);

/** Return the world coordinates of the first voxel. */
Point FirstVoxelOf(vtkImageData* image);

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
 * Return min(v, Lower + Upper - v), which is above Lower where v is within the range. The result is
 * float, or double if the type has more digits than float, with the same name.
 * @param voxels contiguous in memory, one component
 * @throws std::bad_alloc, ScratchFull
 */
vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads);
}

#endif
