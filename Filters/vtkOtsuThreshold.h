// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkOtsuThreshold
 * @brief   an iso-value for an image about which nothing is known
 *
 * vtkOtsuThreshold finds the value that separates the voxels into two classes of the largest
 * variance between them. It is a guess: in a CT it finds the skin rather than the bone.
 *
 * @par Input:
 * A vtkImageData, or a composite dataset with one image in it, or a pyramid, whose level 0 is
 * taken; the array chosen by SetInputArrayToProcess(), by default the active point scalars, or the
 * active cell scalars where points have none: numbers. NaN and blanked voxels (see vtkImagePyramid)
 * are left out, and so is the padding of a CT: voxels of a smallest value below -1024, if they are a
 * hundredth of all or more and no other is within 400 of it.
 *
 * @par Output:
 * A vtkTable with one row and the column `Threshold` (double), in the units of the voxels. No voxel
 * has this value, so that a surface of that value passes between voxels: it lies in the middle of
 * the largest voxel below and the smallest one above, or k + 1/2 for integers.
 *
 * @par Algorithm:
 * A histogram of 1024 bins between the smallest and the largest voxel is split. Where several
 * splits are as good, as in a gap between the classes, the middle one is taken. (VTK has no such
 * filter, and ParaView none of VTK's histograms.)
 *
 * @par Processes:
 * In a parallel run the first process (piece 0) requests the whole image. The others have an empty
 * table and no threshold.
 *
 * @par Errors:
 * Voxels that are all equal, all NaN, or infinite, inputs that are no image, and images without
 * such an array or component: a message by ErrorEvent, an empty table, and GetErrorCode() is
 * vtkErrorCode::UserError (0 after a good run); Update() goes on, as vtkImagePyramid says.
 *
 * @par Thanks:
 * N. Otsu, "A threshold selection method from gray-level histograms", IEEE Trans. SMC 9, 1979.
 *
 * @sa
 * vtkVolumeToSurface
 */
#ifndef vtkOtsuThreshold_h
#define vtkOtsuThreshold_h

#include "vtkFiltersVolumicModule.h" // For export macro
#include "vtkTableAlgorithm.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>

class VTKFILTERSVOLUMIC_EXPORT vtkOtsuThreshold : public vtkTableAlgorithm
{
public:
  static vtkOtsuThreshold* New();
  vtkTypeMacro(vtkOtsuThreshold, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Which component of an array of several is taken: 0 for the first one; -1, the default: the
   * magnitude. An array of one component is taken as it is with either.
   */
  vtkSetMacro(SelectedComponent, int);
  vtkGetMacro(SelectedComponent, int);
  ///@}

  /**
   * The threshold of the last update; NaN if there is none.
   */
  vtkGetMacro(Threshold, double);

  /**
   * A second threshold, for a bright part of the object: Otsu's threshold of the voxels above Threshold,
   * rounded to two digits. It separates bone in CT and vessels in MR, for example. NaN if the object has
   * less than a tenth of the voxels, or the bright part a tenth or more.
   */
  vtkGetMacro(BrightThreshold, double);

  /**
   * The histogram that it was found by: the smallest and the largest voxel, and how many voxels each
   * of the 1024 bins between them has; empty if there is none.
   */
  vtkDoubleArray* GetHistogram();

protected:
  vtkOtsuThreshold();
  ~vtkOtsuThreshold() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

  int SelectedComponent;
  double Threshold;
  double BrightThreshold;
  vtkNew<vtkDoubleArray> Histogram;

private:
  vtkOtsuThreshold(const vtkOtsuThreshold&) = delete;
  void operator=(const vtkOtsuThreshold&) = delete;
};

#endif
