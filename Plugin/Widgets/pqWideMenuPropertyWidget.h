// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqWideMenuPropertyWidget_h
#define pqWideMenuPropertyWidget_h

#include <pqIntVectorPropertyWidget.h>

/**
 * A menu with long entries, in a row of its own below its label: beside it, the panel would need more
 * width than ParaView gives it, and all else would be cut off at its right side.
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

  bool isSingleRowItem() const override { return true; }

private:
  Q_DISABLE_COPY(pqWideMenuPropertyWidget)
};

#endif
