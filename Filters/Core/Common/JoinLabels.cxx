// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/JoinLabels.h"

#include "Core/Common/DisjointSets.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace volumic
{
JoinedSets JoinLabels(const std::vector<SetPiece>& pieces,
  const std::vector<std::pair<int, int>>& joins, std::int64_t least)
{
  DisjointSets joined(pieces.size());
  for (const std::pair<int, int>& join : joins)
  {
    joined.Join(join.first, join.second);
  }
  std::vector<std::int64_t> whole(pieces.size(), 0); // By root.
  for (std::size_t piece = 0; piece < pieces.size(); ++piece)
  {
    whole[joined.Find(static_cast<int>(piece))] += pieces[piece].Size;
  }
  std::vector<int> order(pieces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&pieces](int a, int b) { return pieces[a].First < pieces[b].First; });
  JoinedSets sets;
  std::vector<int> label(pieces.size(), JoinedSets::None); // By root.
  sets.LabelOf.assign(pieces.size(), JoinedSets::None);
  for (const int piece : order)
  {
    const int root = joined.Find(piece);
    if (whole[root] >= least && label[root] == JoinedSets::None)
    {
      label[root] = static_cast<int>(sets.Labels.size());
      sets.Labels.push_back({ pieces[piece].First, whole[root] });
    }
    sets.LabelOf[piece] = label[root];
  }
  return sets;
}
}
