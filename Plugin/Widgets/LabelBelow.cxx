// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelBelow.h"

#include <QBoxLayout>
#include <QGridLayout>
#include <QLabel>
#include <QTimer>

namespace
{
/** Align the label on the left of a property's widget with its first row. */
void alignLabel(QWidget* widget, int heightOfRow)
{
  auto* grid =
    widget->parentWidget() ? qobject_cast<QGridLayout*>(widget->parentWidget()->layout()) : nullptr;
  const int index = grid ? grid->indexOf(widget) : -1;
  int row = 0, column = 0, spans[2] = { 0, 0 };
  if (index >= 0)
  {
    grid->getItemPosition(index, &row, &column, &spans[0], &spans[1]);
  }
  QLayoutItem* left = column > 0 ? grid->itemAtPosition(row, column - 1) : nullptr;
  if (left && left->widget())
  {
    left->widget()->setMinimumHeight(heightOfRow);
    left->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  }
}
}

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
  // The editor; buttons follow it.
  row->setStretch(0, 1);
  delete former;
  auto* column = new QVBoxLayout(widget);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addLayout(row);
  column->addWidget(label);
  // The panel adds the widget to its layout after this call.
  QTimer::singleShot(0, widget, [widget, row] { alignLabel(widget, row->sizeHint().height()); });
  return label;
}
}
