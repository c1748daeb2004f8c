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
 * Shows the range of the domain of a property of one number below its widget, as Contour does: "Value
 * Range: [0, 1300]". If it is that of Hounsfield units, values of bone and skin are offered. Else a
 * second threshold is offered if the domain has one. With several time steps, the label reports that
 * all have one value. The slider gets a row of its own below the histogram of the voxels, if the
 * domain (vtkSMOtsuThresholdDomain) has one. The histogram shows the range to Upper Value if the proxy
 * uses it.
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

  /** Set the value in the panel; with isDone also for Auto Apply. */
  void give(double value, bool isDone);

  QLabel* Label; ///< the property's widget owns both
  volumic::HistogramWidget* Histogram;
};

#endif
