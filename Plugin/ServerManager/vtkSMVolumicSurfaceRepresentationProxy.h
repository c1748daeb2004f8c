// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicSurfaceRepresentationProxy
 * @brief   a surface with colours that suit its arrays, and of several blocks the one to look at
 *
 * ParaView's display of geometry, with four differences:
 * - Only arrays of points and cells are offered as colours. The field data of a surface are numbers
 *   about it, of which there are more than arrays.
 * - A colour map of its own is given to an array that is coloured by for the first time. `Residual`
 *   gets one that diverges from 0, as far to both sides as ResidualQuantile (field data) says;
 *   `Component` a colour for each of the twenty largest, and grey for the others. Both follow new
 *   data until they are edited.
 * - Of a surface that has been stopped on its way the view says so, see UnfinishedText.
 * - With <ShownBlock place="first"/> or "last" among the hints of the proxy, a new display of
 *   blocks shows the first or last one that isn't empty, until somebody chooses others.
 */
#ifndef vtkSMVolumicSurfaceRepresentationProxy_h
#define vtkSMVolumicSurfaceRepresentationProxy_h

#include "UnfinishedText.h" // For the text
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

  /**
   * For a new display: from now on, shows the block that the hint names, as long as nobody chooses
   * others.
   */
  virtual void StartPresets();

  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMVolumicSurfaceRepresentationProxy();
  ~vtkSMVolumicSurfaceRepresentationProxy() override;

  void CreateVTKObjects() override;
  int ReadXMLAttributes(vtkSMSessionProxyManager* manager, vtkPVXMLElement* element) override;

  /** Whether arrays of field data are among the colours to choose from. */
  virtual bool IsFieldDataOffered() const { return false; }
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
   * Gives the colour map in use the range or the values of the data: one that has none yet, or
   * still those that it got here.
   */
  void AdaptColors();
  void AdaptResidualColors(vtkSMProxy* colors, vtkPVDataInformation* data);
  void AdaptComponentColors(vtkSMProxy* colors, vtkPVDataInformation* data);
  void ChooseBlock();
  /** Empty if there is none. */
  std::string FindBlockToShow();

  /** What was set here last: the range is from minus it to it, the values are 0 to it. */
  double ResidualRange = -1.0;
  int LastComponent = -1;
  volumic::UnfinishedText Text;
  std::string ChosenBlock;
  bool IsChoosingBlock = false;
};

#endif
