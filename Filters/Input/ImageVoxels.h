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

// Arrays of images as voxels. The messages of InvalidArgument name the array and how to fix it.

namespace volumic
{
/** Return the name of the selected array, or an empty string for the active scalars. */
std::string ChosenName(vtkInformation* selection);

/**
 * Return the selected array of voxels.
 * @param selection GetInputArrayInformation(0) of the filter
 * @throws InvalidArgument if it is not numeric point data with a value for every voxel
 */
vtkDataArray* ChooseArray(vtkInformation* selection, vtkImageData* image);

/** Return the selected array. @throws InvalidArgument also if it has several components */
vtkDataArray* ChooseVoxels(vtkInformation* selection, vtkImageData* image);

/**
 * Return the array itself if it has one component. Otherwise return a copy of a component, or, for
 * -1, the magnitude of all as floating-point numbers. The name stays the same.
 * @throws InvalidArgument if there is no such component
 */
vtkSmartPointer<vtkDataArray> SelectComponent(vtkDataArray* array, int component);

/** Return a shallow copy with these active scalars, which replace an array of the same name. */
vtkSmartPointer<vtkImageData> WithVoxels(vtkImageData* image, vtkDataArray* voxels);

/** Return the values contiguous in memory: the array itself if it is contiguous. */
vtkSmartPointer<vtkDataArray> ContiguousVoxels(vtkDataArray* voxels);

/** Call `work` with a pointer to the voxels, which must be contiguous in memory. */
template <typename Work>
void VisitVoxels(vtkDataArray* voxels, const Work& work)
{
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(work(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0))));
  }
}

/** Return whether the error of rounding to float is at most 1e-5 of the range. */
bool FitsFloat(double smallest, double largest);

/** Return `array 'name'`, for messages. */
std::string NameOf(vtkDataArray* array);

Point FirstVoxelOf(vtkImageData* image);

/** Return `256 x 256 x 108`, for messages. */
std::string SizeOf(vtkImageData* image);

/** The values of an object: Lower < image < Upper. */
struct ValueRange
{
  double Lower = 0.0;
  double Upper = std::numeric_limits<double>::infinity(); ///< infinite: not used

  bool IsUsed() const { return this->Upper != std::numeric_limits<double>::infinity(); }
  /** @throws InvalidArgument if it is used, unless Lower is finite and less than Upper */
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
