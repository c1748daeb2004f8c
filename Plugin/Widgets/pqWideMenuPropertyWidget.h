// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqWideMenuPropertyWidget_h
#define pqWideMenuPropertyWidget_h

#include <pqIntVectorPropertyWidget.h>

/**
 * A menu with long entries that does not keep to the panel's column of labels, whose width is that
 * of the longest word: with both, the panel would need more width than ParaView gives it, and all
 * else would be cut off at its right side.
 *
 *   <IntVectorProperty panel_widget="WideMenu" ...>
 */
class pqWideMenuPropertyWidget : public pqIntVectorPropertyWidget
{
  Q_OBJECT

public:
  pqWideMenuPropertyWidget(
    vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqWideMenuPropertyWidget() override;

private:
  Q_DISABLE_COPY(pqWideMenuPropertyWidget)
};

#endif
