// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqWideMenuPropertyWidget.h"

//------------------------------------------------------------------------------
pqWideMenuPropertyWidget::pqWideMenuPropertyWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : pqIntVectorPropertyWidget(property, proxy, parent)
{
}

pqWideMenuPropertyWidget::~pqWideMenuPropertyWidget() = default;
