// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSurfaces_h
#define volumicLabelSurfaces_h

#include "Core/Common/Communicator.h"
#include "Host/HostThreads.h"
#include "Labels/LabelSurface.h"

#include <string>
#include <vector>

namespace volumic
{
/**
 * By all ranks, which have the same label map: the surfaces of its objects. Each rank makes some,
 * about as much work as any other: those that are large one after another, each by all threads; the
 * others side by side, each by one.
 *
 * @param names           of the objects that get surfaces, from 1 on; those beyond them only claim
 *                        places between
 * @param numberOfThreads 0: all
 * @param progress        called on the calling thread, with a text such as `12 of 39, liver`; after
 *                        false on any rank, what is not finished is stopped
 * @param finished        at rank 0, surfaces that a run of the same that was stopped has given;
 *                        empty: none
 * @return at rank 0, one for each of them
 */
std::vector<LabelSurface> MakeLabelSurfaces(Communicator& ranks, LabelSurfaceMaker& maker,
  const LabelBricks& bricks, const std::vector<std::string>& names, int numberOfThreads,
  HostThreads& threads, const LabelSurfaceMaker::Progress& progress,
  std::vector<LabelSurface> finished = {});
}

#endif
