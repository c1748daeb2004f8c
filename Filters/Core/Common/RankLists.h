// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankLists_h
#define volumicRankLists_h

#include "Core/Common/Communicator.h"

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace volumic
{
namespace detail
{
template <typename T>
Message MessageOf(const std::vector<T>& list)
{
  MessageWriter writer;
  writer.AddArray(list);
  return writer.Take();
}

template <typename T>
std::vector<T> ListIn(const Message& message)
{
  return MessageReader(message).TakeVector<T>();
}

template <typename T>
std::vector<std::vector<T>> ListsIn(const std::vector<Message>& messages)
{
  std::vector<std::vector<T>> lists;
  for (const Message& message : messages)
  {
    lists.push_back(ListIn<T>(message));
  }
  return lists;
}

template <typename T>
std::vector<T> JoinedLists(const std::vector<Message>& messages)
{
  std::vector<T> all;
  for (const Message& message : messages)
  {
    const std::vector<T> ofRank = ListIn<T>(message);
    all.insert(all.end(), ofRank.begin(), ofRank.end());
  }
  return all;
}
}

/** @return the list of each rank, by rank, on all ranks. */
template <typename T>
std::vector<std::vector<T>> GatherEachOnAll(Communicator& ranks, const std::vector<T>& list)
{
  return detail::ListsIn<T>(ranks.GatherOnAll(detail::MessageOf(list)));
}

/** @return the lists of all ranks, one after the other, at rank 0; nothing elsewhere. */
template <typename T>
std::vector<T> GatherLists(Communicator& ranks, const std::vector<T>& list)
{
  return detail::JoinedLists<T>(ranks.Gather(detail::MessageOf(list)));
}

/** @return the lists of all ranks, one after the other, on all ranks. */
template <typename T>
std::vector<T> GatherListsOnAll(Communicator& ranks, const std::vector<T>& list)
{
  return detail::JoinedLists<T>(ranks.GatherOnAll(detail::MessageOf(list)));
}

/** @return the list of rank 0. */
template <typename T>
std::vector<T> BroadcastList(Communicator& ranks, const std::vector<T>& list)
{
  return detail::ListIn<T>(ranks.Broadcast(detail::MessageOf(list)));
}

/** @param lists to each rank, by rank @return those of all ranks to this one, by rank */
template <typename T>
std::vector<std::vector<T>> ExchangeLists(
  Communicator& ranks, const std::vector<std::vector<T>>& lists)
{
  std::vector<Message> messages;
  for (const std::vector<T>& list : lists)
  {
    messages.push_back(detail::MessageOf(list));
  }
  return detail::ListsIn<T>(ranks.Exchange(std::move(messages)));
}

/**
 * What ranks do to a list one after the other, rank 0 first, each to what the one before has left.
 * @return what the last has left, on all ranks
 */
template <typename T, typename Work>
std::vector<T> InOrderOfRanks(Communicator& ranks, std::vector<T> list, Work&& work)
{
  const int own = ranks.Rank();
  const int last = ranks.NumberOfRanks() - 1;
  if (own > 0)
  {
    list = detail::ListIn<T>(ranks.Pass(own - 1, own));
  }
  work(list);
  if (own < last)
  {
    ranks.Pass(own, own + 1, detail::MessageOf(list));
  }
  Message left;
  if (own == 0 || own == last)
  {
    left = ranks.Pass(last, 0, own == last ? detail::MessageOf(list) : Message());
  }
  return detail::ListIn<T>(ranks.Broadcast(std::move(left)));
}

/** @return the sum of the values of all ranks, on all ranks. */
template <typename T>
T SumOfRanks(Communicator& ranks, const T& value)
{
  const std::vector<T> values = GatherValues(ranks, value);
  return std::accumulate(values.begin(), values.end(), T());
}

/** Sends a message to one rank and gets one from another, all ranks in a ring of the same step. */
inline Message Trade(Communicator& ranks, int to, int from, Message message)
{
  std::vector<Message> messages(static_cast<std::size_t>(ranks.NumberOfRanks()));
  messages[static_cast<std::size_t>(to)] = std::move(message);
  std::vector<int> partners = { to };
  if (from != to)
  {
    partners.push_back(from);
  }
  return std::move(ranks.Exchange(std::move(messages), partners)[static_cast<std::size_t>(from)]);
}
}

#endif
