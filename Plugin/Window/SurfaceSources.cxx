// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSources.h"

#include <pqPipelineFilter.h>

#include <vtkSMProxy.h>

#include <QString>

namespace volumic
{
//------------------------------------------------------------------------------
bool IsOfSurface(pqPipelineSource* source)
{
  const QString name = source->getProxy()->GetXMLName();
  auto* filter = qobject_cast<pqPipelineFilter*>(source);
  return name == "DeformableSurface" || name == "VolumeToSurface" || name == "LabelsToSurfaces" ||
    (filter && filter->getInput(0) && IsOfSurface(filter->getInput(0)));
}
}
