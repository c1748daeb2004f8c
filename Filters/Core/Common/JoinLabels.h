// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJoinLabels_h
#define volumicJoinLabels_h

#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
/** What a span has of a connected set: its smallest element, and how many. */
struct SetPiece
{
  std::int64_t First;
  std::int64_t Size;
};

/** The sets that pieces make. */
struct JoinedSets
{
  static constexpr int None = -1;

  std::vector<int> LabelOf;     ///< By piece; None: of a set that is left out.
  std::vector<SetPiece> Labels; ///< By label: the whole set.
};

/**
 * Sets that were found span by span: pieces that touch over a border become one.
 * They are labelled from 0 in the order of their smallest elements, however they were cut.
 * @param joins places of pieces that are of one set
 * @param least sets of fewer elements are left out
 */
JoinedSets JoinLabels(const std::vector<SetPiece>& pieces,
  const std::vector<std::pair<int, int>>& joins, std::int64_t least = 0);
}

#endif
