// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSources_h
#define volumicSurfaceSources_h

#include <QList>

#include <string>

class pqPipelineSource;
class pqPropertiesPanel;
class vtkPVDataInformation;

namespace volumic
{
/** Return whether the source is a filter of Volumic that produces surfaces. */
bool ProducesSurfaces(pqPipelineSource* source);

/** Return whether the source is such a filter, or downstream of one. */
bool IsDownstreamOfSurface(pqPipelineSource* source);

/** Return the StopReason of a stopped run; empty for a finished run. */
std::string UnfinishedReason(vtkPVDataInformation* surfaces);

/** Return the properties panels of the window. There are none before its startup has finished. */
QList<pqPropertiesPanel*> PropertiesPanels();
}

#endif
