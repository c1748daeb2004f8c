// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqSummaryDecorator_h
#define pqSummaryDecorator_h

#include "pqPropertyWidgetDecorator.h"

class QLabel;

/**
 * Tells below the widget of a property what the filter's last run has given: by the field data of
 * its first output, which must be that of vtkDeformableSurface or vtkLabelsToSurfaces. Before a run
 * there is nothing.
 *
 *   <PropertyWidgetDecorator type="Summary"/>
 */
class pqSummaryDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqSummaryDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent);
  ~pqSummaryDecorator() override;

private Q_SLOTS:
  void showSummary();

private:
  Q_DISABLE_COPY(pqSummaryDecorator)

  QLabel* Label; ///< the property's widget owns it
};

#endif
