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
/** The voxels of a label. */
struct LabelVoxels
{
  vtkIdType Count = 0;
  /** Indices of the first and last along each axis, as an extent of VTK. */
  std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };

  void Add(const LabelVoxels& others);
};

/** A label map as it comes in. Errors are std::invalid_argument. */
class LabelImage
{
public:
  /** More labels than this are no label map, where nobody has chosen some of them. */
  static constexpr std::size_t MostLabels = 4096;

  /**
   * @param selection as GetInputArrayInformation()
   * @throws where there is no image of three axes, or no array of one component whose values are
   *         labels as LabelValuesOf() has them.
   */
  LabelImage(vtkDataObject* input, vtkInformation* selection, int background, Executor& executor);

  /** Voxels are its points; without arrays that matter. */
  vtkImageData* Image() const { return this->Geometry; }
  const std::map<int, LabelVoxels>& Labels() const { return this->Counts; }
  /** Labels of the image, as texts, that no int holds, by the numbers that they have here. */
  const std::map<int, std::string>& RenumberedLabels() const { return this->Numbers; }
  /** What the user should know: what was done to make labels of the values. Empty: nothing. */
  const std::string& Warning() const { return this->Conversions; }

  /** @throws where there are more than MostLabels. */
  void CheckNumberOfLabels() const;

  /**
   * Sorted: those that are wanted; all but the background where none are.
   * @throws where there are none, or too many, or one is not there.
   */
  std::vector<int> Choose(const std::vector<int>& requested, int background) const;

  /**
   * Return a map whose objects are all labels but the background, in the order of their values, so
   * that numbers do not depend on the selection. Merged labels are one object. Where there are more
   * labels than numbers, the last that are not selected are background.
   * @param selected the labels that get surfaces, sorted
   * @param objects  set to theirs
   */
  LabelMap MakeMap(const std::vector<int>& selected, bool merge, int background,
    std::vector<int>& objects, Executor& executor) const;

  /** Return a warning if the voxels look like those of a scan, else nothing. */
  std::string ScanWarning(int background) const;

  /** For each triangle the label of the voxel nearest to its centroid, of those given, sorted. */
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
