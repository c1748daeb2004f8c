// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqValueRangeDecorator.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>

#include <vtkCommand.h>
#include <vtkSMDoubleRangeDomain.h>
#include <vtkSMProperty.h>

#include <QBoxLayout>
#include <QLabel>

namespace
{
/** Gives the widget a second row. */
void AddBelow(QWidget* widget, QWidget* below)
{
  auto* row = new QHBoxLayout;
  QLayout* former = widget->layout();
  row->setSpacing(former->spacing());
  while (QLayoutItem* item = former->takeAt(0))
  {
    row->addItem(item);
  }
  // The first is what the value is edited by, buttons come after it.
  row->setStretch(0, 1);
  delete former;
  auto* column = new QVBoxLayout(widget);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addLayout(row);
  column->addWidget(below);
}
}

//------------------------------------------------------------------------------
pqValueRangeDecorator::pqValueRangeDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(xml, parent)
  , Label(new QLabel(parent))
{
  this->Label->setObjectName("ValueRange");
  this->Label->setWordWrap(true);
  AddBelow(parent, this->Label);
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
