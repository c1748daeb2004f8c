// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumeTypeDomain
 * @brief   vtkSMDataTypeDomain that refuses adaptively refined grids
 *
 * The grids of an AMR dataset are images, and so ParaView takes the dataset for one where images
 * are wanted. Which types are taken is said in the XML as for vtkSMDataTypeDomain.
 */
#ifndef vtkSMVolumeTypeDomain_h
#define vtkSMVolumeTypeDomain_h

#include "vtkSMDataTypeDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMVolumeTypeDomain : public vtkSMDataTypeDomain
{
public:
  static vtkSMVolumeTypeDomain* New();
  vtkTypeMacro(vtkSMVolumeTypeDomain, vtkSMDataTypeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int IsInDomain(vtkSMProperty* property) override;

protected:
  vtkSMVolumeTypeDomain();
  ~vtkSMVolumeTypeDomain() override;

private:
  vtkSMVolumeTypeDomain(const vtkSMVolumeTypeDomain&) = delete;
  void operator=(const vtkSMVolumeTypeDomain&) = delete;
};

#endif
