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
/** Whether it is a filter of Volumic that gives surfaces. */
bool GivesSurfaces(pqPipelineSource* source);

/** Whether it is one, or comes after one. */
bool IsOfSurface(pqPipelineSource* source);

/** The StopReason of surfaces whose run was stopped; empty for those of a finished run. */
std::string WhyUnfinished(vtkPVDataInformation* surfaces);

/** Those of the window, which has none yet when a plugin is loaded at the start. */
QList<pqPropertiesPanel*> PropertiesPanels();
}

#endif
