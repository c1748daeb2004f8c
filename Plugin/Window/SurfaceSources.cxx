// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSources.h"

#include <pqCoreUtilities.h>
#include <pqPipelineFilter.h>
#include <pqPropertiesPanel.h>

#include <vtkSMProxy.h>

#include <QString>

namespace volumic
{
//------------------------------------------------------------------------------
bool GivesSurfaces(pqPipelineSource* source)
{
  const QString name = source->getProxy()->GetXMLName();
  return name == "DeformableSurface" || name == "VolumeToSurface" || name == "LabelsToSurfaces";
}

//------------------------------------------------------------------------------
bool IsOfSurface(pqPipelineSource* source)
{
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  return GivesSurfaces(source) ||
    (filter && filter->getInput(0) && IsOfSurface(filter->getInput(0)));
}

//------------------------------------------------------------------------------
QList<pqPropertiesPanel*> PropertiesPanels()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? window->findChildren<pqPropertiesPanel*>() : QList<pqPropertiesPanel*>();
}
}
