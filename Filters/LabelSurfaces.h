// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSurfaces_h
#define volumicLabelSurfaces_h

#include "HostThreads.h"
#include "LabelSurface.h"

#include <vector>

namespace volumic
{
/**
 * The surfaces of objects of a label map: those that are large one after another, each by all
 * threads; the others side by side, each by one.
 *
 * @param wanted          the objects from 1 to this one get surfaces; those beyond it only claim
 *                        places between
 * @param numberOfThreads 0: all
 * @param progress        called on the calling thread; after false, what is not finished is stopped
 * @return one for each of them
 */
std::vector<LabelSurface> MakeLabelSurfaces(LabelSurfaceMaker& maker, const LabelBricks& bricks,
  int wanted, int numberOfThreads, HostThreads& threads,
  const LabelSurfaceMaker::Progress& progress);
}

#endif
