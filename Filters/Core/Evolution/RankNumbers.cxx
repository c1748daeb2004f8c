// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/RankNumbers.h"

#include "Core/Common/RankLists.h"

#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** A vertex that is to be numbered: an own one with its faces, or one that is only asked for. */
struct Numbered
{
  static constexpr int Asked = -1;
  int Vertex;
  int Faces;
};

/** Numbers a stretch of the vertices, of all ranks. @return what each rank has asked for */
std::vector<std::vector<VertexNumber>> NumberStretch(Communicator& ranks,
  const std::vector<std::vector<Numbered>>& vertices, std::size_t first, std::size_t count,
  VertexNumber& all)
{
  LargeVector<VertexNumber> numbers;
  MakeZeroed(numbers, count);
  for (const std::vector<Numbered>& ofRank : vertices)
  {
    for (const Numbered& v : ofRank)
    {
      if (v.Faces != Numbered::Asked)
      {
        numbers[static_cast<std::size_t>(v.Vertex) - first] = { 1, v.Faces };
      }
    }
  }
  VertexNumber next;
  const auto addUp = [&next](const VertexNumber& more)
  {
    const VertexNumber before = next;
    next = { next.Point + more.Point, next.Face + more.Face };
    return before;
  };
  for (VertexNumber& number : numbers)
  {
    number = addUp(number);
  }
  const std::vector<VertexNumber> ofRanks =
    GatherValues(ranks, std::exchange(next, VertexNumber()));
  VertexNumber before;
  for (std::size_t rank = 0; rank < ofRanks.size(); ++rank)
  {
    before = rank == static_cast<std::size_t>(ranks.Rank()) ? next : before;
    addUp(ofRanks[rank]);
  }
  all = next;
  std::vector<std::vector<VertexNumber>> answers;
  for (const std::vector<Numbered>& ofRank : vertices)
  {
    answers.emplace_back();
    for (const Numbered& v : ofRank)
    {
      const VertexNumber& number = numbers[static_cast<std::size_t>(v.Vertex) - first];
      answers.back().push_back({ before.Point + number.Point, before.Face + number.Face });
    }
  }
  return answers;
}
}

VertexNumbers NumberOnRanks(Communicator& ranks, std::size_t places,
  const std::function<int(int v)>& facesOf, const std::vector<int>& own,
  const std::vector<int>& others)
{
  const auto count = static_cast<std::size_t>(ranks.NumberOfRanks());
  const std::size_t stretch = places / count + 1;
  std::vector<std::vector<Numbered>> wanted(count);
  for (const int v : own)
  {
    wanted[static_cast<std::size_t>(v) / stretch].push_back({ v, facesOf(v) });
  }
  for (const int v : others)
  {
    wanted[static_cast<std::size_t>(v) / stretch].push_back({ v, Numbered::Asked });
  }
  VertexNumbers numbers;
  const std::size_t first = stretch * static_cast<std::size_t>(ranks.Rank());
  const std::vector<std::vector<VertexNumber>> answers = ExchangeLists(ranks,
    NumberStretch(ranks, ExchangeLists(ranks, wanted), first, stretch, numbers.All));
  MakeZeroed(numbers.Of, places);
  for (std::size_t rank = 0; rank < count; ++rank)
  {
    for (std::size_t i = 0; i < wanted[rank].size(); ++i)
    {
      numbers.Of[wanted[rank][i].Vertex] = answers[rank][i];
    }
  }
  return numbers;
}
}
