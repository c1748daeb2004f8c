// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqUnitDecorator.h"

#include <pqPropertyWidget.h>

#include <vtkPVXMLElement.h>

#include <QGridLayout>
#include <QLabel>

//------------------------------------------------------------------------------
pqUnitDecorator::pqUnitDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : pqPropertyWidgetDecorator(xml, parent)
{
  auto* unit = new QLabel(QString::fromUtf8(xml->GetAttribute("text")), parent);
  unit->setObjectName("Unit");
  if (auto* grid = qobject_cast<QGridLayout*>(parent->layout()))
  {
    grid->addWidget(unit, 0, grid->columnCount());
  }
  else
  {
    parent->layout()->addWidget(unit);
  }
}

pqUnitDecorator::~pqUnitDecorator() = default;
