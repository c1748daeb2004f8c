// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqUnitDecorator_h
#define pqUnitDecorator_h

#include "pqPropertyWidgetDecorator.h"

/**
 * Shows the unit of a number beside its widget. Not in the property's label, of which ParaView makes
 * its name in Python.
 *
 *   <PropertyWidgetDecorator type="Unit" text="s"/>
 */
class pqUnitDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqUnitDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent);
  ~pqUnitDecorator() override;

private:
  Q_DISABLE_COPY(pqUnitDecorator)
};

#endif
