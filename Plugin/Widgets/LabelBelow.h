// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelBelow_h
#define volumicLabelBelow_h

class QLabel;
class QWidget;

namespace volumic
{
/** Add a row of text below the widget of a property. The widget owns the label. */
QLabel* AddLabelBelow(QWidget* widget, const char* name);
}

#endif
