// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMSelectedComponentDomain
 * @brief   the components of an array by their names, and its magnitude, which is -1
 *
 * The choices of a property of one integer, for the array that another property chooses: required
 * are the properties Input and ArraySelection, as for vtkSMArrayRangeDomain. (ParaView's
 * vtkSMNumberOfComponentsDomain counts the magnitude as the component after the last.)
 */
#ifndef vtkSMSelectedComponentDomain_h
#define vtkSMSelectedComponentDomain_h

#include "vtkSMEnumerationDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMSelectedComponentDomain : public vtkSMEnumerationDomain
{
public:
  static vtkSMSelectedComponentDomain* New();
  vtkTypeMacro(vtkSMSelectedComponentDomain, vtkSMEnumerationDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* requestingProperty) override;
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMSelectedComponentDomain();
  ~vtkSMSelectedComponentDomain() override;

private:
  vtkSMSelectedComponentDomain(const vtkSMSelectedComponentDomain&) = delete;
  void operator=(const vtkSMSelectedComponentDomain&) = delete;
};

#endif
