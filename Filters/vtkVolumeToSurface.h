// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumeToSurface
 * @brief   the surface of an object in an image, in one step
 *
 * vtkVolumeToSurface is vtkDeformableSurface for an image at hand: it makes the pyramid itself, and
 * without an IsoValue it takes vtkOtsuThreshold's.
 *
 * @par Input:
 * Port 0: a vtkImageData, as vtkDeformableSurface says; an array of cells serves too (their centres
 * are the voxels), and is taken where points have no active scalars. A composite dataset with one
 * image in it serves as that image, a pyramid as its level 0. Port 1: as there.
 *
 * @par Output:
 * As vtkDeformableSurface.
 *
 * @par Errors:
 * As vtkDeformableSurface: ask GetErrorCode() after Update(). A label map (integers, almost all of
 * which are their neighbours' value) is a warning, once, that tells of vtkLabelsToSurfaces.
 *
 * @sa
 * vtkDeformableSurface vtkImagePyramid vtkLabelsToSurfaces vtkOtsuThreshold
 */
#ifndef vtkVolumeToSurface_h
#define vtkVolumeToSurface_h

#include "vtkDeformableSurface.h"
#include "vtkFiltersVolumicModule.h" // For export macro

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
   * Number of levels of the pyramid, the image included. 0, the default: as many as
   * MinimumLevelSize allows.
   */
  virtual void SetNumberOfLevels(int value);
  virtual int GetNumberOfLevels();
  ///@}

  ///@{
  /**
   * With NumberOfLevels 0: no level after the image has an axis of fewer voxels than this.
   * Default: 10.
   */
  virtual void SetMinimumLevelSize(int value);
  virtual int GetMinimumLevelSize();
  ///@}

  ///@{
  /**
   * How many times fewer voxels a level has along each axis than the level below it. Between 1 and
   * 2, both excluded. Default: sqrt(3).
   */
  virtual void SetReductionFactor(double value);
  virtual double GetReductionFactor();
  ///@}

  /**
   * What is told of an image whose active point scalars look like a label map: that there is
   * vtkLabelsToSurfaces; empty: they don't.
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
