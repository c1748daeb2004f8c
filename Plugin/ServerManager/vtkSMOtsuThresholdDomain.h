// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMOtsuThresholdDomain
 * @brief   the range of an array, with Otsu's threshold of it as the default value
 *
 * A property of one number with this domain is preset from the data when its proxy is made, and
 * whenever the user presses the button that resets it to the data. The threshold is computed where
 * the data is, by the helper proxy (internal_filters, OtsuThreshold). Where it can't be, as for
 * voxels that are all equal, the middle of the range is the default, as of vtkSMArrayRangeDomain,
 * whose required properties are those of this one: Input and ArraySelection.
 */
#ifndef vtkSMOtsuThresholdDomain_h
#define vtkSMOtsuThresholdDomain_h

#include "vtkSMArrayRangeDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMOtsuThresholdDomain : public vtkSMArrayRangeDomain
{
public:
  static vtkSMOtsuThresholdDomain* New();
  vtkTypeMacro(vtkSMOtsuThresholdDomain, vtkSMArrayRangeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMOtsuThresholdDomain();
  ~vtkSMOtsuThresholdDomain() override;

private:
  vtkSMOtsuThresholdDomain(const vtkSMOtsuThresholdDomain&) = delete;
  void operator=(const vtkSMOtsuThresholdDomain&) = delete;

  /// NaN if there is none.
  double ComputeThreshold();
};

#endif
