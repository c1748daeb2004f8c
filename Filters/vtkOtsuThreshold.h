// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkOtsuThreshold
 * @brief   compute Otsu's threshold of an image
 *
 * vtkOtsuThreshold computes the value that separates the voxels into two classes with the largest
 * variance between them. It is a first guess for IsoValue: in a CT it finds the skin, not the bone.
 *
 * @par Input:
 * Port 0: a vtkImageData, a composite dataset with one image, or a pyramid, of which the filter
 * uses level 0. SetInputArrayToProcess() chooses the array (default: active point scalars, or
 * active cell scalars if there are none), of any numeric type. The filter ignores
 * - NaN voxels and blanked voxels, see vtkImagePyramid
 * - the padding of a CT: voxels of the smallest value, if it is less than -1024, if they are at
 *   least a hundredth of all voxels, and if no other voxel is within 400 of it
 *
 * @par Output:
 * Port 0: a vtkTable with one row and the column `Threshold` (double), in the units of the voxels.
 * No voxel has this value: it is the mean of the largest voxel below and the smallest voxel above,
 * or k + 1/2 for integers.
 *
 * @par Algorithm:
 * The filter splits a histogram of 1024 bins between the smallest and the largest voxel. If several
 * splits are equally good, as in a gap between the classes, it takes the middle one.
 *
 * @par Errors:
 * On error the filter invokes `ErrorEvent`, produces an empty table and sets GetErrorCode() to
 * vtkErrorCode::UserError. Errors are voxels that are all equal, all NaN, or infinite, an input
 * that is not an image, and a missing array or component.
 *
 * @par Processes:
 * In a parallel run the first process (piece 0) requests the whole image. The others have an empty
 * table and no threshold.
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
   * Set/Get the component of the voxels, from 0 (default -1: the magnitude of all components). An
   * array of one component is not changed by -1 or 0.
   */
  vtkSetMacro(SelectedComponent, int);
  vtkGetMacro(SelectedComponent, int);
  ///@}

  /**
   * Return the threshold of the last update in the units of the voxels, or NaN if there is none.
   */
  vtkGetMacro(Threshold, double);

  /**
   * Return a second threshold, for a bright part of the object such as bone in CT or vessels in MR.
   * It is Otsu's threshold of the voxels above Threshold, rounded to two digits. It is NaN if the
   * object has less than a tenth of the voxels, or the bright part a tenth or more.
   */
  vtkGetMacro(BrightThreshold, double);

  /**
   * Return the histogram: the smallest and the largest voxel, and the number of voxels in each of
   * the 1024 bins between them. It is empty if there is no threshold.
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
