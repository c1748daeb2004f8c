// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMLabelsDomain
 * @brief   the labels of the input, for a property that lists some of them
 *
 * All values are allowed, and none is preset. GetLabels() counts the labels on the server that has
 * the data. It counts them again if the input or its array has changed. The domain invokes
 * DomainModifiedEvent before that.
 *
 * Required properties: Input and ArraySelection.
 */
#ifndef vtkSMLabelsDomain_h
#define vtkSMLabelsDomain_h

#include "vtkSMDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <array>  // For the rows
#include <string> // For the rows
#include <tuple>  // For Choice
#include <vector> // For the rows

class vtkSMSourceProxy;

namespace volumic
{
struct LabelRow
{
  int Label = 0;
  std::string Name;
  long long Voxels = 0;
  std::array<double, 3> Color = { { 0.0, 0.0, 0.0 } };
};

struct LabelRows
{
  std::vector<LabelRow> Rows; ///< of a label map by value, of surfaces in the order of their blocks
  std::string Problem;        ///< error message if there are none
};
}

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMLabelsDomain : public vtkSMDomain
{
public:
  static vtkSMLabelsDomain* New();
  vtkTypeMacro(vtkSMLabelsDomain, vtkSMDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* requestingProperty) override;

  /**
   * Return the labels of a label map, or of the output of Labels to Surfaces, by the helper proxy
   * (internal_filters, LabelList).
   * @param array elements of SetInputArrayToProcess; empty: the active scalars
   */
  static volumic::LabelRows FetchLabels(
    vtkSMSourceProxy* producer, unsigned int port, const std::array<std::string, 5>& array = {});

  /** Return the labels of the input as it is now, before Apply. */
  const volumic::LabelRows& GetLabels();

protected:
  vtkSMLabelsDomain();
  ~vtkSMLabelsDomain() override;

private:
  vtkSMLabelsDomain(const vtkSMLabelsDomain&) = delete;
  void operator=(const vtkSMLabelsDomain&) = delete;

  /** Producer, port, array, and modification time of the data. */
  using Choice =
    std::tuple<vtkSMSourceProxy*, unsigned int, std::array<std::string, 5>, vtkMTimeType>;
  Choice CurrentChoice();

  Choice Fetched;
  volumic::LabelRows Labels;
  bool IsFetching = false;
};

#endif
