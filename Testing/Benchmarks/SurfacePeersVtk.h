// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The steps of VTK that several peers begin or end with. */

#ifndef volumicSurfacePeersVtk_h
#define volumicSurfacePeersVtk_h

#include "SurfacePeers.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace volumic::bench
{

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue);

/** The largest component of the former, smoothed. What it was made from is freed. */
vtkSmartPointer<vtkPolyData> Smoothed(vtkImageData* image, double isoValue);

} // namespace volumic::bench

#endif
