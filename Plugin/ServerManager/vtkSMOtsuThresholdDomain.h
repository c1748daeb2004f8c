// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMOtsuThresholdDomain
 * @brief   the range of an array, with Otsu's threshold as the default value
 *
 * A property of one number with this domain is preset from the data when its proxy is created, and
 * when the user presses its reset button. While the property has its preset value, it is preset
 * again if the input, array or component changes. Values set by the user remain. The domain updates
 * data that were never updated, as in a script.
 *
 * The helper proxy (internal_filters, OtsuThreshold) computes the threshold on the server that has
 * the data. If there is no threshold, for example if all voxels are equal, the default is the
 * middle of the range, as of vtkSMArrayRangeDomain.
 *
 * Required properties: Input, ArraySelection and ComponentSelection (-1: magnitude).
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

  /** Histogram of the voxels of an array. If there is none, thresholds are NaN and counts empty. */
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

  /** Input, array and component; without a producer if there is no input. */
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
  /** Choose an array if none is chosen, or if a new input does not have it. */
  void ChooseArray(bool isNewInput);
  const Histogram& FindHistogram(const Choice& choice, vtkPVDataInformation* data);
  void UpdateRange(const Choice& choice);
  void Follow(const Choice& choice);

  Choice Preset;      ///< choice when the property was preset
  double PresetValue; ///< NaN before that
  bool Following = false;
  Choice Seen; ///< choice at the last DomainModifiedEvent, and modification time of its data
  vtkMTimeType SeenTime = 0;
  Choice Found; ///< choice of the histogram, and modification time of its data
  vtkMTimeType FoundTime = 0;
  Histogram Voxels;
};

#endif
