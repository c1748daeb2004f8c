// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqSummaryPropertyWidget_h
#define pqSummaryPropertyWidget_h

#include <pqPropertyWidget.h>

class QLabel;

/**
 * Shows the field data of the first output of a vtkDeformableSurface or vtkLabelsToSurfaces. The
 * unit of lengths is the field data LengthUnit of the input, if it has this array.
 *
 *   <Property name="Result" label="Result" panel_widget="Summary"/>
 */
class pqSummaryPropertyWidget : public pqPropertyWidget
{
  Q_OBJECT

public:
  pqSummaryPropertyWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqSummaryPropertyWidget() override;

private Q_SLOTS:
  void showSummary();

private:
  Q_DISABLE_COPY(pqSummaryPropertyWidget)

  QLabel* Label;
};

#endif
