// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqValueRangeDecorator_h
#define pqValueRangeDecorator_h

#include "pqPropertyWidgetDecorator.h"

class QLabel;
namespace volumic
{
class HistogramWidget;
}

/**
 * Shows the range of a property of one number below its widget, as Contour does: "Value Range:
 * [0, 1300]". It is that of the property's domain, and follows it. Where it is that of Hounsfield
 * units, values of bone and skin are offered. Else a second threshold is offered, if the domain has
 * one. The label reports that the value applies to all time steps, if there are several. The slider, if there is one, gets a row of its own,
 * below the histogram of the voxels, if the domain (vtkSMOtsuThresholdDomain) has one. Where the
 * proxy has Upper Value, and uses it, the histogram shows the range.
 *
 *   <PropertyWidgetDecorator type="ValueRange"/>
 */
class pqValueRangeDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqValueRangeDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent);
  ~pqValueRangeDecorator() override;

private Q_SLOTS:
  void showRange();
  void showValue();
  void showUpper();
  void take(const QString& value);

private:
  Q_DISABLE_COPY(pqValueRangeDecorator)

  /** To the panel; done: for Auto Apply, too. */
  void give(double value, bool isDone);

  QLabel* Label; ///< the property's widget owns both
  volumic::HistogramWidget* Histogram;
};

#endif
