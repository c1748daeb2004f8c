// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqValueRangeDecorator.h"

#include "HistogramWidget.h"
#include "LabelBelow.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>

#include <vtkCommand.h>
#include <vtkSMDoubleRangeDomain.h>
#include <vtkSMOtsuThresholdDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QBoxLayout>
#include <QLabel>
#include <QSlider>

#include <cmath>
#include <limits>

namespace
{
/** Return whether a range may be that of Hounsfield units, from air (-1000) to bone. */
bool areHounsfieldUnits(double low, double high)
{
  return low <= -800.0 && low >= -4096.0 && high >= 300.0 && high <= 32767.0;
}
}

//------------------------------------------------------------------------------
pqValueRangeDecorator::pqValueRangeDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(xml, parent), Label(volumic::AddLabelBelow(parent, "ValueRange")),
    Histogram(new volumic::HistogramWidget(parent))
{
  // Beside the number, the slider is too short at the initial width of the panel.
  auto* slider = parent->findChild<QSlider*>();
  auto* column = qobject_cast<QBoxLayout*>(parent->layout());
  if (slider && column)
  {
    slider->parentWidget()->layout()->removeWidget(slider);
    column->insertWidget(column->indexOf(this->Label), slider);
    column->insertWidget(column->indexOf(slider), this->Histogram);
  }
  this->Histogram->Dragged = [this](double value, bool isDone) { this->setValue(value, isDone); };
  this->connect(this->Label, SIGNAL(linkActivated(const QString&)), SLOT(onLink(const QString&)));
  this->showRange();
  this->showValue();
  pqCoreUtilities::connect(
    parent->property(), vtkCommand::DomainModifiedEvent, this, SLOT(showRange()));
  pqCoreUtilities::connect(
    parent->property(), vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(showValue()));
  for (const char* name : { "UpperValue", "UseUpperValue" })
  {
    if (vtkSMProperty* property = parent->proxy()->GetProperty(name))
    {
      pqCoreUtilities::connect(
        property, vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(showUpper()));
    }
  }
  this->showUpper();
}

pqValueRangeDecorator::~pqValueRangeDecorator() = default;

//------------------------------------------------------------------------------
void pqValueRangeDecorator::showRange()
{
  auto* range = this->parentWidget()->property()->FindDomain<vtkSMDoubleRangeDomain>();
  const bool isKnown = range && range->GetMinimumExists(0) && range->GetMaximumExists(0);
  auto* voxels = this->parentWidget()->property()->FindDomain<vtkSMOtsuThresholdDomain>();
  this->Label->setVisible(isKnown);
  if (isKnown)
  {
    const double low = range->GetMinimum(0), high = range->GetMaximum(0);
    QString text = tr("<b>Value Range:</b> [%1, %2]").arg(low).arg(high);
    if (areHounsfieldUnits(low, high))
    {
      text += tr("<br>CT: <a href='226'>bone 226</a>, <a href='-300'>skin -300</a>");
    }
    else if (voxels && !std::isnan(voxels->GetHistogram().BrightThreshold))
    {
      text += tr("<br>Small part: <a href='%1'>bright %1</a>")
                .arg(voxels->GetHistogram().BrightThreshold);
    }
    if (voxels && voxels->HasTimeSteps())
    {
      text += tr("<br>One value for all time steps");
    }
    this->Label->setText(text);
  }
  if (voxels)
  {
    const vtkSMOtsuThresholdDomain::Histogram& histogram = voxels->GetHistogram();
    this->Histogram->SetCounts(
      histogram.Low, histogram.High, histogram.Counts, histogram.Threshold);
  }
  this->Histogram->setVisible(voxels && !voxels->GetHistogram().Counts.empty());
}

//------------------------------------------------------------------------------
void pqValueRangeDecorator::showValue()
{
  this->Histogram->SetValue(
    vtkSMUncheckedPropertyHelper(this->parentWidget()->property()).GetAsDouble());
}

//------------------------------------------------------------------------------
void pqValueRangeDecorator::showUpper()
{
  vtkSMProxy* proxy = this->parentWidget()->proxy();
  vtkSMProperty* upper = proxy->GetProperty("UpperValue");
  vtkSMProperty* use = proxy->GetProperty("UseUpperValue");
  const bool isUsed = upper && use && vtkSMUncheckedPropertyHelper(use).GetAsInt() != 0;
  this->Histogram->SetUpper(isUsed ? vtkSMUncheckedPropertyHelper(upper).GetAsDouble()
                                   : std::numeric_limits<double>::quiet_NaN());
}

//------------------------------------------------------------------------------
void pqValueRangeDecorator::onLink(const QString& value)
{
  this->setValue(value.toDouble(), true);
}

//------------------------------------------------------------------------------
void pqValueRangeDecorator::setValue(double value, bool isDone)
{
  pqPropertyWidget* widget = this->parentWidget();
  vtkSMUncheckedPropertyHelper(widget->property()).Set(0, value);
  Q_EMIT widget->changeAvailable();
  if (isDone)
  {
    Q_EMIT widget->changeFinished();
  }
}
