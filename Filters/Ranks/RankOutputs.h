// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankOutputs_h
#define volumicRankOutputs_h

#include "Ranks/RankInputs.h"
#include "Ranks/Ranks.h"

#include <functional>
#include <string>

namespace volumic
{
/** What becomes of the outputs that the first rank has made. */
enum class Dealing
{
  InPieces,   ///< Each rank gets its piece.
  FirstHasAll ///< The others get surfaces without points, and blocks of the same names.
};

/** What the ranks of a filter do in RequestData. */
struct RankWork
{
  std::function<void()> OfFirst; ///< takes the inputs, fills the outputs
  Ranks::Answer OfOthers;        ///< for RankQuestion::Own; may be empty
  Dealing Deals = Dealing::InPieces;
};

/**
 * RequestData of a filter, by all ranks: the first one works, then each gets its piece of the
 * outputs (Pieces.h), with the ghosts that are asked for. One rank alone works and keeps all.
 * @param aboutMemory see RunAlgorithm
 * @return what to report, the same on all ranks
 */
AlgorithmError RunOnRanks(Ranks& ranks, const FilterCall& call,
  const std::function<std::string()>& aboutMemory, const RankWork& work);
}

#endif
