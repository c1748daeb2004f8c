// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicLabelsRepresentationProxy
 * @brief   surfaces of labels, each in the colour of its label
 *
 * vtkSMVolumicSurfaceRepresentationProxy with a difference: a new display is coloured by the cell
 * array `Label` as soon as there is one. Its colour map has a category per label, with the name and
 * the colour that the field data of the surfaces tell. As long as nobody has edited the categories,
 * they are those of the data; after that, labels that come anew get one in addition.
 */
#ifndef vtkSMVolumicLabelsRepresentationProxy_h
#define vtkSMVolumicLabelsRepresentationProxy_h

#include "ColorMaps.h" // For the categories
#include "vtkSMVolumicSurfaceRepresentationProxy.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMVolumicLabelsRepresentationProxy
  : public vtkSMVolumicSurfaceRepresentationProxy
{
public:
  static vtkSMVolumicLabelsRepresentationProxy* New();
  vtkTypeMacro(vtkSMVolumicLabelsRepresentationProxy, vtkSMVolumicSurfaceRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void StartPresets() override;
  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMVolumicLabelsRepresentationProxy();
  ~vtkSMVolumicLabelsRepresentationProxy() override;

  void AdaptColorsOf(
    const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data) override;

private:
  vtkSMVolumicLabelsRepresentationProxy(const vtkSMVolumicLabelsRepresentationProxy&) = delete;
  void operator=(const vtkSMVolumicLabelsRepresentationProxy&) = delete;

  bool IsWaitingForLabels = false;
  std::vector<volumic::ColorCategory> Given; ///< the categories that were set here last
  vtkMTimeType AdaptedTime = 0;              ///< of what was known of the data then
};

#endif
