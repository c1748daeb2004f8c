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
 * Shows the range of a property below its widget: "Value Range: [0, 1300]". If it is a range of
 * Hounsfield units, links set the values of bone and skin. Otherwise a link sets the second
 * threshold of the domain (vtkSMOtsuThresholdDomain), if there is one. A note says that all time
 * steps have one value. The slider is below the histogram of the domain, which shows the range to
 * Upper Value if the proxy uses it.
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
  void onLink(const QString& value);

private:
  Q_DISABLE_COPY(pqValueRangeDecorator)

  /** Set the value in the panel. With isDone, Auto Apply applies it. */
  void setValue(double value, bool isDone);

  QLabel* Label; ///< owned by the property's widget, as Histogram
  volumic::HistogramWidget* Histogram;
};

#endif
