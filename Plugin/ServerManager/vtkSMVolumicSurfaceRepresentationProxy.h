// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicSurfaceRepresentationProxy
 * @brief   a surface with colours that suit its arrays, and of several blocks the one to look at
 *
 * ParaView's display of geometry, with three differences:
 * - Only arrays of points and cells are offered as colours. The field data of a surface are numbers
 *   about it, of which there are more than arrays.
 * - Arrays have colour maps of their own. That of `Component` has a colour for each of the ten
 *   largest components, and grey for the others. It follows new data until it is edited.
 * - With <ShownBlock place="first"/> or "last" among the hints of the proxy, a new display of
 *   blocks shows the first or last one that isn't empty, until somebody chooses others.
 */
#ifndef vtkSMVolumicSurfaceRepresentationProxy_h
#define vtkSMVolumicSurfaceRepresentationProxy_h

#include "vtkSMPVRepresentationProxy.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <string> // For the chosen block

class vtkPVDataInformation;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMVolumicSurfaceRepresentationProxy
  : public vtkSMPVRepresentationProxy
{
public:
  static vtkSMVolumicSurfaceRepresentationProxy* New();
  vtkTypeMacro(vtkSMVolumicSurfaceRepresentationProxy, vtkSMPVRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void ViewUpdated(vtkSMProxy* view) override;
  int LoadXMLState(vtkPVXMLElement* element, vtkSMProxyLocator* locator) override;

protected:
  vtkSMVolumicSurfaceRepresentationProxy();
  ~vtkSMVolumicSurfaceRepresentationProxy() override;

  void CreateVTKObjects() override;
  int ReadXMLAttributes(vtkSMSessionProxyManager* manager, vtkPVXMLElement* element) override;

  /** A new display gets presets, one of a saved state does not. */
  bool IsNew = true;

  /** Of a colour map that is this display's own, in use for the array. */
  virtual void AdaptColorsOf(
    const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data);
  /** What is known of the input, or of a block of it; null: it has none. */
  vtkPVDataInformation* GetInputInformation(const std::string& block = "");

private:
  vtkSMVolumicSurfaceRepresentationProxy(const vtkSMVolumicSurfaceRepresentationProxy&) = delete;
  void operator=(const vtkSMVolumicSurfaceRepresentationProxy&) = delete;

  void OnPropertyModified(vtkObject* caller, unsigned long event, void* name);
  /**
   * Gives the colour map in use the values of the data: one that has none yet, or still those that
   * it got here.
   */
  void AdaptColors();
  void AdaptComponentColors(vtkSMProxy* colors, vtkPVDataInformation* data);
  void ChooseBlock();
  /** Empty if there is none. */
  std::string FindBlockToShow();

  int LastComponent = -1; ///< the colour map that was set here last has the values 0 to it
  std::string ChosenBlock;
};

#endif
