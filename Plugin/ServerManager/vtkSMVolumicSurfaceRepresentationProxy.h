// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicSurfaceRepresentationProxy
 * @brief   display of surfaces with presets of colours and of the visible block
 *
 * Differences from ParaView's display of geometry:
 * - Only point and cell arrays are offered for colouring, not the field data of a surface.
 * - Arrays have separate colour maps. The map of `Component` has a colour for each of the ten
 * largest components, and grey for the others. It follows new data until the user edits it.
 * - With the hint <ShownBlock position="first"/> or "last", a new display shows the first or last
 * block that is not empty, until the user chooses others.
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

  /** False for a display of a saved state, which gets no presets. */
  bool IsNew = true;

  /** Set the separate colour map of an array. */
  virtual void AdaptColorsOf(
    const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data);
  /** Return the data information of the input or of one of its blocks, or null. */
  vtkPVDataInformation* GetInputInformation(const std::string& block = "");

private:
  vtkSMVolumicSurfaceRepresentationProxy(const vtkSMVolumicSurfaceRepresentationProxy&) = delete;
  void operator=(const vtkSMVolumicSurfaceRepresentationProxy&) = delete;

  void OnPropertyModified(vtkObject* caller, unsigned long event, void* name);
  /** Set the current colour map unless the user has edited it. */
  void AdaptColors();
  void AdaptComponentColors(vtkSMProxy* colors, vtkPVDataInformation* data);
  void ChooseBlock();
  /** Return its selector; empty if there is none. */
  std::string FindBlockToShow();

  int LastComponent = -1; ///< largest value in the colour map that was set last
  std::string ChosenBlock;
};

#endif
