// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMPyramidLevelsDomain
 * @brief   the levels that a pyramid has: a range whose end follows from the input
 *
 * The range goes from the attribute `min` of the domain to the last level of the input: of a
 * pyramid the number of its blocks tells it, of an image vtkImagePyramid::CountLevels(). Where the
 * input isn't known yet, or gives no pyramid, the end is the attribute `max`. The value of the
 * property is never changed.
 *
 * Required properties: Input; if there, ArraySelection (of arrays of cells the cells are the
 * voxels) and NumberOfLevels, MinimumLevelSize and ReductionFactor, without which those of
 * vtkImagePyramid are taken.
 */
#ifndef vtkSMPyramidLevelsDomain_h
#define vtkSMPyramidLevelsDomain_h

#include "vtkSMIntRangeDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class vtkPVDataInformation;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMPyramidLevelsDomain : public vtkSMIntRangeDomain
{
public:
  static vtkSMPyramidLevelsDomain* New();
  vtkTypeMacro(vtkSMPyramidLevelsDomain, vtkSMIntRangeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* property) override;

  /** None: what the property's XML says stays. */
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMPyramidLevelsDomain();
  ~vtkSMPyramidLevelsDomain() override;

  int ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element) override;

private:
  vtkSMPyramidLevelsDomain(const vtkSMPyramidLevelsDomain&) = delete;
  void operator=(const vtkSMPyramidLevelsDomain&) = delete;

  /** 0 if they are not known. */
  int CountLevels(vtkPVDataInformation* data);
  int CountLevelsOfImage(const int extent[6]);

  int First;
  int LastWithoutInput;
};

#endif
