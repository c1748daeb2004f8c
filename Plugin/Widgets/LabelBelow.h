// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelBelow_h
#define volumicLabelBelow_h

class QLabel;
class QWidget;

namespace volumic
{
/** Gives the widget of a property a second row, of text. The widget owns it. */
QLabel* AddLabelBelow(QWidget* widget, const char* name);
}

#endif
