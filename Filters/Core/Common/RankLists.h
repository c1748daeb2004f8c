// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankLists_h
#define volumicRankLists_h

#include "Core/Common/Communicator.h"

#include <cstddef>
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

/** @return the list of each rank, by rank, at rank 0; nothing elsewhere. */
template <typename T>
std::vector<std::vector<T>> GatherEach(Communicator& ranks, const std::vector<T>& list)
{
  return detail::ListsIn<T>(ranks.Gather(detail::MessageOf(list)));
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
}

#endif
