// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqValueRangeDecorator.h"

#include "LabelBelow.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>

#include <vtkCommand.h>
#include <vtkSMDoubleRangeDomain.h>
#include <vtkSMProperty.h>

#include <QLabel>

//------------------------------------------------------------------------------
pqValueRangeDecorator::pqValueRangeDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(xml, parent)
  , Label(volumic::AddLabelBelow(parent, "ValueRange"))
{
  this->showRange();
  pqCoreUtilities::connect(
    parent->property(), vtkCommand::DomainModifiedEvent, this, SLOT(showRange()));
}

pqValueRangeDecorator::~pqValueRangeDecorator() = default;

//------------------------------------------------------------------------------
void pqValueRangeDecorator::showRange()
{
  auto* range = this->parentWidget()->property()->FindDomain<vtkSMDoubleRangeDomain>();
  const bool isKnown = range && range->GetMinimumExists(0) && range->GetMaximumExists(0);
  this->Label->setVisible(isKnown);
  if (isKnown)
  {
    this->Label->setText(
      tr("<b>Value Range:</b> [%1, %2]").arg(range->GetMinimum(0)).arg(range->GetMaximum(0)));
  }
}
