// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicLabelsRepresentationProxy
 * @brief   surfaces of labels, each in the colour of its label
 *
 * vtkSMVolumicSurfaceRepresentationProxy with a difference: a new display is coloured by `Label` as
 * soon as there are surfaces: by the field data, as ParaView takes seconds to look up each triangle
 * where labels are many; of a surface about several labels by the cell array. The colour map has a
 * category per label, with the name and the colour that the field data tell. As long as nobody has
 * edited the categories, they are those of the data; after that, labels that come anew get one in
 * addition. Field data are among the colours to choose from, as each block has its own.
 *
 * What is made of the surfaces, such as a clip, is coloured by the map that all displays of `Label`
 * share. It gets the same categories, unless others have given it a range or categories before.
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

  bool IsFieldDataOffered() const override { return true; }
  void AdaptColorsOf(
    const std::string& array, vtkSMProxy* colors, vtkPVDataInformation* data) override;

private:
  vtkSMVolumicLabelsRepresentationProxy(const vtkSMVolumicLabelsRepresentationProxy&) = delete;
  void operator=(const vtkSMVolumicLabelsRepresentationProxy&) = delete;

  /** Brings Wanted up to date. */
  void FetchCategories(vtkPVDataInformation* data);
  /** Colours by the array `Label` that tells all labels, if it is this display's business. */
  void ChooseLabels(vtkPVDataInformation* data, vtkSMProxy* view);
  /** Whether a surface is about several labels. */
  bool IsMerged(vtkPVDataInformation* data);
  /** Sets the categories that the map has from here; completes what others have edited. */
  void GiveCategories(vtkSMProxy* colors, std::vector<volumic::ColorCategory> wanted);
  void GiveToOthers(const std::vector<volumic::ColorCategory>& wanted);

  std::vector<volumic::ColorCategory> Wanted; ///< those of the data
  std::vector<volumic::ColorCategory> Given;         ///< what was set here last
  std::vector<volumic::ColorCategory> GivenToOthers; ///< likewise, of the map that is shared
  vtkMTimeType WantedTime = 0;  ///< of what was known of the data then
  vtkMTimeType AdaptedTime = 0; ///< likewise, when the colour map was set
};

#endif
