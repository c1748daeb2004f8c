// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelBelow.h"

#include <QBoxLayout>
#include <QLabel>

namespace volumic
{
//------------------------------------------------------------------------------
QLabel* AddLabelBelow(QWidget* widget, const char* name)
{
  auto* label = new QLabel(widget);
  label->setObjectName(name);
  label->setWordWrap(true);
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
  column->addWidget(label);
  return label;
}
}
