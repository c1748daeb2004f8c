// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMOtsuThresholdDomain
 * @brief   the range of an array, with Otsu's threshold of it as the default value
 *
 * A property of one number with this domain is preset from the data when its proxy is made, and
 * whenever the user presses the button that resets it to the data. As long as the property keeps
 * the value that it was preset to, it follows the choice of another input, array or component; a
 * value that someone has given stays. Data that was never updated, as in a script, is updated for
 * it.
 *
 * The threshold is computed where the data is, by the helper proxy (internal_filters,
 * OtsuThreshold). Where it can't be, as for voxels that are all equal, the middle of the range is
 * the default, as of vtkSMArrayRangeDomain, whose required properties are those of this one: Input,
 * ArraySelection and ComponentSelection, of which -1 is the magnitude.
 *
 * Widgets show the histogram that the threshold is computed from (GetHistogram()).
 */
#ifndef vtkSMOtsuThresholdDomain_h
#define vtkSMOtsuThresholdDomain_h

#include "vtkSMArrayRangeDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <string> // For the key of the preset
#include <vector> // For the histogram

class vtkPVDataInformation;
class vtkSMSourceProxy;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMOtsuThresholdDomain : public vtkSMArrayRangeDomain
{
public:
  static vtkSMOtsuThresholdDomain* New();
  vtkTypeMacro(vtkSMOtsuThresholdDomain, vtkSMArrayRangeDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* requestingProperty) override;
  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

  /** Of the voxels of an array. Thresholds are NaN, and the rest empty, if there is none. */
  struct Histogram
  {
    double Low = 0.0; ///< smallest and largest voxel
    double High = 0.0;
    std::vector<double> Counts;
    double Threshold;
    double BrightThreshold; ///< see vtkOtsuThreshold
  };
  /** Return the histogram of the chosen array; empty before its data exist. It is computed once. */
  const Histogram& GetHistogram();
  /** Return whether the input has several time steps. */
  bool HasTimeSteps();

protected:
  vtkSMOtsuThresholdDomain();
  ~vtkSMOtsuThresholdDomain() override;

private:
  vtkSMOtsuThresholdDomain(const vtkSMOtsuThresholdDomain&) = delete;
  void operator=(const vtkSMOtsuThresholdDomain&) = delete;

  /** What is chosen now; nothing where there is no input. */
  struct Choice
  {
    vtkSMSourceProxy* Producer = nullptr;
    unsigned int Port = 0;
    std::string Array[5]; ///< as SetInputArrayToProcess
    int Component = -1;

    bool HasArray() const { return this->Producer && !this->Array[4].empty(); }
    bool operator==(const Choice& other) const;
  };
  Choice CurrentChoice(bool useUnchecked = true);
  /** Where none is chosen, as of data that was never updated, or none that a new input has. */
  void ChooseArray(bool isNewInput);
  const Histogram& FindHistogram(const Choice& choice, vtkPVDataInformation* data);
  void UpdateRange(const Choice& choice);
  void Follow(const Choice& choice);

  Choice Preset;      ///< what was chosen when the property was preset
  double PresetValue; ///< NaN: it never was
  bool Following = false;
  Choice Seen;  ///< as all have been told, and since when its data are so
  vtkMTimeType SeenTime = 0;
  Choice Found; ///< what the histogram is of, and since when
  vtkMTimeType FoundTime = 0;
  Histogram Voxels;
};

#endif
