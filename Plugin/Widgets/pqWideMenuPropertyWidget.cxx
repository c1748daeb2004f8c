// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqWideMenuPropertyWidget.h"

#include <vtkSMProperty.h>

#include <QBoxLayout>
#include <QLabel>

//------------------------------------------------------------------------------
pqWideMenuPropertyWidget::pqWideMenuPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqIntVectorPropertyWidget(property, proxy, parent)
{
  this->setShowLabel(false);
  auto* row = qobject_cast<QBoxLayout*>(this->layout());
  row->insertWidget(0, new QLabel(property->GetXMLLabel(), this));
  row->setStretch(1, 1);
}

pqWideMenuPropertyWidget::~pqWideMenuPropertyWidget() = default;
