// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSources_h
#define volumicSurfaceSources_h

class pqPipelineSource;

namespace volumic
{
/** Whether it is a filter of Volumic that gives surfaces. */
bool GivesSurfaces(pqPipelineSource* source);

/** Whether it is one, or comes after one. */
bool IsOfSurface(pqPipelineSource* source);
}

#endif
