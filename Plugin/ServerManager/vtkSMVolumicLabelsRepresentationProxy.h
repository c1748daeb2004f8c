// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicLabelsRepresentationProxy
 * @brief   surfaces of labels, each in the colour of its label
 *
 * A new display is coloured by the cell array `Label` as soon as there are surfaces. The colour map
 * has a category per label, with the name and colour of the field data. The categories follow the
 * data until the user edits them. After that only categories of new labels are added.
 *
 * Displays of downstream filters, such as Clip, use this colour map if they are coloured by
 * `Label`. A display in the same view takes precedence. Displays with a separate colour map, or of
 * the surfaces of several label maps, do not change.
 *
 * By default the legend is shown for up to twelve labels. It is shown or hidden again when the
 * number of labels crosses this limit.
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

  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMVolumicLabelsRepresentationProxy();
  ~vtkSMVolumicLabelsRepresentationProxy() override;

  void CreateVTKObjects() override;

  void AdaptColorsOf(
    const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data) override;

private:
  vtkSMVolumicLabelsRepresentationProxy(const vtkSMVolumicLabelsRepresentationProxy&) = delete;
  void operator=(const vtkSMVolumicLabelsRepresentationProxy&) = delete;

  void OnSessionModified(vtkObject* caller, unsigned long event, void* data);
  /** Return this display's own colour map of `Label`, or null. */
  vtkSMProxy* FindLabelColors();
  /** Assign the colour map to the displays of downstream filters. */
  void ShareColors();
  /** Update colour map and legend after a run. */
  void FollowData();
  /** Show the legend, or hide it if the labels are too many. */
  void ShowLegend(vtkSMProxy* view);

  bool IsFollowing = false;
  std::vector<volumic::ColorCategory> Given; ///< categories set last
  std::size_t Count = 0;                     ///< labels of the data
  std::size_t CountInLegend = 0;             ///< labels when the legend was last shown or hidden
  vtkMTimeType AdaptedTime = 0;              ///< time of the data when the colour map was set
};

#endif
