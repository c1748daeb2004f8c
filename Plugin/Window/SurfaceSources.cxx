// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSources.h"

#include <pqCoreUtilities.h>
#include <pqPipelineFilter.h>
#include <pqPropertiesPanel.h>

#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMProxy.h>

#include <QString>

namespace volumic
{
//------------------------------------------------------------------------------
bool ProducesSurfaces(pqPipelineSource* source)
{
  const QString name = source->getProxy()->GetXMLName();
  return name == "DeformableSurface" || name == "VolumeToSurface" || name == "LabelsToSurfaces";
}

//------------------------------------------------------------------------------
bool IsDownstreamOfSurface(pqPipelineSource* source)
{
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  return ProducesSurfaces(source) ||
    (filter && filter->getInput(0) && IsDownstreamOfSurface(filter->getInput(0)));
}

//------------------------------------------------------------------------------
std::string UnfinishedReason(vtkPVDataInformation* surfaces)
{
  // Blocks of labels have one value each.
  vtkPVArrayInformation* reasons =
    surfaces->GetArrayInformation("StopReason", vtkDataObject::FIELD);
  for (int i = 0; reasons && i < reasons->GetNumberOfStringValues(); ++i)
  {
    const std::string reason = reasons->GetStringValue(i);
    if (reason == "cancelled" || reason == "time limit")
    {
      return reason;
    }
  }
  return "";
}

//------------------------------------------------------------------------------
QList<pqPropertiesPanel*> PropertiesPanels()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? window->findChildren<pqPropertiesPanel*>() : QList<pqPropertiesPanel*>();
}
}
