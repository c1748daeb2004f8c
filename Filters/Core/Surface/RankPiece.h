// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankPiece_h
#define volumicRankPiece_h

#include "Core/Common/Communicator.h"

#include <functional>

namespace volumic
{
/**
 * A rank's piece of a surface that several ranks work on, each in a state of its own: a vertex has
 * the same index on all of them, a rank has those alive that it owns, and those about them, which
 * others own. All other places are empty, though rings of the outermost may name them. A face
 * belongs to the rank that owns its smallest vertex.
 *
 * Who is given one must call what it is given to on all ranks.
 */
struct RankPiece
{
  Communicator& Ranks;
  /** Whether an alive vertex is this rank's; each is of one rank. Threads ask side by side. */
  std::function<bool(int v)> IsOwn;
};
}

#endif
