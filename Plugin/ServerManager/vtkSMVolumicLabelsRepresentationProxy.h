// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicLabelsRepresentationProxy
 * @brief   surfaces of labels, each in the colour of its label
 *
 * vtkSMVolumicSurfaceRepresentationProxy with a difference: a new display is coloured by the cell array
 * `Label` as soon as there are surfaces. The colour map has a category per label, with the name and
 * the colour of the field data. The categories follow the data until they are edited. After that only
 * categories of new labels are added.
 *
 * Displays of what is made of the surfaces, such as a clip, use this colour map, too, where they are
 * coloured by `Label`: that of the display in the same view, or else of any one. Displays with a
 * separate colour map, or made of the surfaces of several label maps, are left alone.
 *
 * The legend is shown by default for up to twelve labels. This is decided anew when the number of
 * labels passes that limit.
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
  /** Give the colour map to the displays of what is made of the surfaces. */
  void ShareColors();
  /** Update colour map and legend after a run. */
  void FollowData();
  /** Show the legend, or hide it if the labels are too many. */
  void ShowLegend(vtkSMProxy* view);

  bool IsFollowing = false;
  std::vector<volumic::ColorCategory> Given; ///< what was set here last
  std::size_t Count = 0;                     ///< labels of the data
  std::size_t CountInLegend = 0;             ///< labels when the legend was decided on
  vtkMTimeType AdaptedTime = 0;              ///< of the data, when the colour map was set
};

#endif
