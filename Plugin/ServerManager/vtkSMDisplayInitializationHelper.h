// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDisplayInitializationHelper
 * @brief   how a new display looks, written in the XML of its proxy
 *
 * ParaView calls it for a proxy whose hints name it, when the proxy has got its defaults:
 *
 *   <InitializationHelper class="vtkSMDisplayInitializationHelper">
 *     <Preset property="DiffuseColor" values="0.9 0.9 0.8"/>
 *     <Preset property="BottomAxisTitle" text="Number of the Iteration"/>
 *     <Preset property="SeriesColor" tuple="4" values="Vertices 0.1 0.35 0.7"/>
 *   </InitializationHelper>
 *
 * The values are separated by blanks; a text is one value. With the size of a tuple, only tuples of
 * the same first value are replaced. What a proxy doesn't have is left out.
 */
#ifndef vtkSMDisplayInitializationHelper_h
#define vtkSMDisplayInitializationHelper_h

#include "vtkSMProxyInitializationHelper.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMDisplayInitializationHelper
  : public vtkSMProxyInitializationHelper
{
public:
  static vtkSMDisplayInitializationHelper* New();
  vtkTypeMacro(vtkSMDisplayInitializationHelper, vtkSMProxyInitializationHelper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void PostInitializeProxy(
    vtkSMProxy* proxy, vtkPVXMLElement* xml, vtkMTimeType initializationTime) override;

protected:
  vtkSMDisplayInitializationHelper();
  ~vtkSMDisplayInitializationHelper() override;

private:
  vtkSMDisplayInitializationHelper(const vtkSMDisplayInitializationHelper&) = delete;
  void operator=(const vtkSMDisplayInitializationHelper&) = delete;
};

#endif
