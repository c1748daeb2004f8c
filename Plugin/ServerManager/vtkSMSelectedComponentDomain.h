// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMSelectedComponentDomain
 * @brief   the components of an array by their names, and the magnitude as -1
 *
 * vtkSMNumberOfComponentsDomain does not have -1, the default of the filters.
 */
#ifndef vtkSMSelectedComponentDomain_h
#define vtkSMSelectedComponentDomain_h

#include "vtkSMNumberOfComponentsDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMSelectedComponentDomain
  : public vtkSMNumberOfComponentsDomain
{
public:
  static vtkSMSelectedComponentDomain* New();
  vtkTypeMacro(vtkSMSelectedComponentDomain, vtkSMNumberOfComponentsDomain);

  void Update(vtkSMProperty* requestingProperty) override;

protected:
  vtkSMSelectedComponentDomain() = default;
  ~vtkSMSelectedComponentDomain() override = default;

private:
  vtkSMSelectedComponentDomain(const vtkSMSelectedComponentDomain&) = delete;
  void operator=(const vtkSMSelectedComponentDomain&) = delete;
};

#endif
