// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMLabelsDomain
 * @brief   the labels of the input, for a property that lists some of them
 *
 * For panels that offer them: all values are allowed, and none is preset. The labels are counted
 * where the data is, only when somebody asks for them, and again once the input or the choice of
 * its array has changed; before that, the domain invokes its DomainModifiedEvent.
 *
 * Required properties: Input and ArraySelection.
 */
#ifndef vtkSMLabelsDomain_h
#define vtkSMLabelsDomain_h

#include "LabelRows.h" // For what it gives
#include "vtkSMDomain.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

#include <tuple> // For the choice

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMLabelsDomain : public vtkSMDomain
{
public:
  static vtkSMLabelsDomain* New();
  vtkTypeMacro(vtkSMLabelsDomain, vtkSMDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void Update(vtkSMProperty* requestingProperty) override;

  /** Those of the input as it is now, before Apply. */
  const volumic::LabelRows& GetLabels();

protected:
  vtkSMLabelsDomain();
  ~vtkSMLabelsDomain() override;

private:
  vtkSMLabelsDomain(const vtkSMLabelsDomain&) = delete;
  void operator=(const vtkSMLabelsDomain&) = delete;

  /** Producer, port, array, and the time of its data: what labels are counted of. */
  using Choice =
    std::tuple<vtkSMSourceProxy*, unsigned int, std::array<std::string, 5>, vtkMTimeType>;
  Choice CurrentChoice();

  Choice Counted;
  volumic::LabelRows Labels;
  bool IsCounting = false;
};

#endif
