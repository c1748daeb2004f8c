// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumeToSurface
 * @brief   segment an image with a closed surface, in one step
 *
 * vtkVolumeToSurface is vtkDeformableSurface for an image: it computes the pyramid, and without an
 * IsoValue it uses the threshold of vtkOtsuThreshold.
 *
 * @par Input:
 * Port 0: a vtkImageData as for vtkDeformableSurface, a composite dataset with one image, or a
 * pyramid, of which the filter uses level 0. The array may also be cell data, whose voxels are the
 * centers of the cells. Cell data are the default if points have no active scalars. Ports 1 and 2:
 * as for vtkDeformableSurface.
 *
 * @par Output:
 * As for vtkDeformableSurface.
 *
 * @par Errors:
 * As for vtkDeformableSurface. The filter warns once if the image looks like a label map, and
 * refers to vtkLabelsToSurfaces.
 *
 * @sa
 * vtkDeformableSurface vtkImagePyramid vtkLabelsToSurfaces vtkOtsuThreshold
 */
#ifndef vtkVolumeToSurface_h
#define vtkVolumeToSurface_h

#include "vtkDeformableSurface.h"
#include "vtkFiltersVolumicModule.h"  // For export macro
#include "vtkVolumicPropertyMacros.h" // For volumicPropertyMacro

#include <string>

class vtkImageData;

class VTKFILTERSVOLUMIC_EXPORT vtkVolumeToSurface : public vtkDeformableSurface
{
public:
  static vtkVolumeToSurface* New();
  vtkTypeMacro(vtkVolumeToSurface, vtkDeformableSurface);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Set/Get the number of pyramid levels, including the image (default 0: limited by
   * MinimumLevelSize).
   */
  volumicPropertyMacro(NumberOfLevels, int);
  /**
   * Set/Get the smallest number of voxels along an axis of a level, with NumberOfLevels 0 (default:
   * 10).
   */
  volumicPropertyMacro(MinimumLevelSize, int);
  /**
   * Set/Get the reduction factor between consecutive levels along each axis, in (1, 2) (default:
   * sqrt(3)).
   */
  volumicPropertyMacro(ReductionFactor, double);
  ///@}

  /**
   * Return a warning that refers to vtkLabelsToSurfaces if the active point scalars of an image
   * look like a label map. Otherwise return an empty string.
   */
  static std::string HintAtLabels(vtkImageData* image);

protected:
  vtkVolumeToSurface();
  ~vtkVolumeToSurface() override;

private:
  vtkVolumeToSurface(const vtkVolumeToSurface&) = delete;
  void operator=(const vtkVolumeToSurface&) = delete;
};

#endif
