// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqSummaryPropertyWidget_h
#define pqSummaryPropertyWidget_h

#include <pqPropertyWidget.h>

class QLabel;

/**
 * Shows what the last run of the filter has produced. The numbers are the field data of its first
 * output, which must be that of vtkDeformableSurface or vtkLabelsToSurfaces; the unit of lengths is
 * the field data LengthUnit of its input, if it has that.
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
