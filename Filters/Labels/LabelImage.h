// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelImage_h
#define volumicLabelImage_h

#include "Core/Common/Executor.h"
#include "Core/Labels/LabelMap.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <map>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkImageData;
class vtkInformation;
class vtkIntArray;
class vtkPolyData;

namespace volumic
{
struct LabelVoxels
{
  vtkIdType Count = 0;
  /** Indices of the first and last voxel along each axis. */
  std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };

  void Add(const LabelVoxels& others);
};

/** An input label map. Errors are InvalidArgument exceptions. */
class LabelImage
{
public:
  /** Maximum number of labels, unless some are selected. */
  static constexpr std::size_t MostLabels = 4096;

  /**
   * @param selection selection of the array, from GetInputArrayInformation()
   * @throws InvalidArgument if there is no 3D image, or no array of one component with labels, see
   *   LabelValuesOf()
   */
  LabelImage(vtkDataObject* input, vtkInformation* selection, int background, Executor& executor);

  /** Return the geometry. Voxels are points. */
  vtkImageData* Image() const { return this->Geometry; }
  const std::map<int, LabelVoxels>& Labels() const { return this->Counts; }
  /** Return the original values of labels outside the range of int, by their new numbers. */
  const std::map<int, std::string>& RenumberedLabels() const { return this->Numbers; }
  /** Return a warning about conversions of the values, or an empty string. */
  const std::string& Warning() const { return this->Conversions; }

  /** @throws InvalidArgument if there are more than MostLabels */
  void CheckNumberOfLabels() const;

  /**
   * Return the requested labels, sorted. If there are none, return all except the background.
   * @throws InvalidArgument if there are none or too many, or if the image lacks a requested one
   */
  std::vector<int> Choose(const std::vector<int>& requested, int background) const;

  /**
   * Return a map whose objects are all labels except the background, in the order of their values,
   * so that numbers do not depend on the selection. Merged labels are one object. If there are more
   * labels than numbers, the last labels that are not selected become background.
   * @param selected labels that get surfaces, sorted
   * @param objects  set to the objects of these labels
   */
  LabelMap MakeMap(const std::vector<int>& selected, bool merge, int background,
    std::vector<int>& objects, Executor& executor) const;

  /** Return a warning if the voxels look like a scan, or an empty string. */
  std::string ScanWarning(int background) const;

  /** For each triangle find the label, out of `labels` (sorted), nearest to its centroid. */
  void FindNearest(vtkPolyData* surface, const std::vector<int>& labels, vtkIntArray* found) const;

private:
  void CountLabels(Executor& executor);

  vtkSmartPointer<vtkImageData> Geometry;
  vtkSmartPointer<vtkDataArray> Voxels;
  std::map<int, LabelVoxels> Counts;
  std::map<int, std::string> Numbers;
  std::string Conversions;
};
}

#endif
