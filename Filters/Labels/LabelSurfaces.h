// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSurfaces_h
#define volumicLabelSurfaces_h

#include "Host/HostThreads.h"
#include "Labels/LabelSurface.h"
#include "Ranks/Ranks.h"

#include <string>
#include <vector>

class vtkImageData;

namespace volumic
{
/**
 * At the first rank: the surfaces of the objects of a label map. Each rank makes some, about as much
 * work as any other (LabelHelper.h).
 *
 * @param frame           where the voxels of the map are
 * @param names           of the objects that get surfaces, from 1 on; those beyond them only claim
 *                        places between
 * @param numberOfThreads 0: all
 * @param progress        called on the calling thread, with a text such as `12 of 39, liver`; after
 *                        false, or where another rank is asked to stop, what is not finished is
 *                        stopped
 * @param finished        surfaces that a run of the same that was stopped has given; empty: none
 * @return one for each of them
 */
std::vector<LabelSurface> MakeLabelSurfaces(Ranks& ranks, LabelSurfaceMaker& maker,
  const LabelBricks& bricks, vtkImageData* frame, const std::vector<std::string>& names,
  int numberOfThreads, HostThreads& threads, const LabelSurfaceMaker::Progress& progress,
  std::vector<LabelSurface> finished = {});
}

#endif
