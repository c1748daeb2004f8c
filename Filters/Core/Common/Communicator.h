// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCommunicator_h
#define volumicCommunicator_h

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace volumic
{
/** Bytes that go from one rank to another. */
using Message = std::vector<char>;

/** Another rank has failed; what() is its message. This one must end its run as well. */
struct OtherRankFailed : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/**
 * The ranks (processes, mostly) that work on one surface. The core knows no MPI: who has it derives
 * from this class (ControllerRanks in the layer of VTK, ThreadRanks in the tests).
 *
 * All ranks make the same calls in the same order. A rank that cannot go on calls Fail(), instead
 * of the calls to come: all the others, whatever call they are in, then throw OtherRankFailed there,
 * and must call Fail() in turn. Fail() returns when all have: nothing is under way any more, and a
 * next run may begin. So no failure of one leaves others waiting.
 *
 * What is gathered, broadcast and scattered goes along a binomial tree of the ranks, so that none
 * sends more than log2 of their number: of the ranks below a rank those that it talks to have one
 * more bit, lower than all of its own. Who waits in the tree waits for a rank that gets on, or fails
 * and then tells all others.
 */
class Communicator
{
public:
  virtual ~Communicator() = default;
  virtual int Rank() const = 0;
  virtual int NumberOfRanks() const = 0;

  /**
   * Sends a message to each rank, its own included, and gets one from each. Empty messages are sent
   * to ranks named by `partners` only; ranks must name each other. Empty `partners`: all.
   * @param messages by rank @return by rank
   */
  std::vector<Message> Exchange(
    std::vector<Message> messages, const std::vector<int>& partners = {});
  /** @return the messages of all ranks at rank 0, by rank; nothing elsewhere. */
  std::vector<Message> Gather(Message message);
  /** Sends a message from one rank to another; both call it. @return it at `to`, else nothing */
  Message Pass(int from, int to, Message message = {});
  /** @return the message of rank 0. */
  Message Broadcast(Message message);
  /** @return the messages of all ranks, by rank, on all ranks. */
  std::vector<Message> GatherOnAll(Message message);
  /** From rank 0 to each: a message by rank, of which only rank 0's matter. */
  Message Scatter(std::vector<Message> messages);
  /** @return whether it is so on any rank. */
  bool IsAny(bool isHere);

  /** What this rank has sent to others, headers included. */
  struct Traffic
  {
    unsigned long long Bytes = 0;
    unsigned long long Messages = 0;
  };
  const Traffic& Sent() const { return this->SentSoFar; }

  /** See above. Does not throw. @param reason what the others shall throw */
  void Fail(const std::string& reason) noexcept;

protected:
  /**
   * To another rank; may return before it is received. Messages of one rank to another arrive in
   * order, and a rank that waits for any of them takes small ones (Header) without the other's help.
   */
  virtual void Send(int to, const void* bytes, std::size_t count) = 0;
  /** Waits for another rank's next bytes: as many as it has sent at once. */
  virtual void Receive(int from, void* bytes, std::size_t count) = 0;
  /** Waits for whichever rank sends next; the header tells which. */
  virtual void ReceiveFromAny(void* bytes, std::size_t count) = 0;

private:
  enum Kind : int
  {
    Content,
    Failure, ///< Its text follows.
    Done     ///< By a rank in Fail(): nothing that it has sent is on the way any more.
  };
  struct Header
  {
    unsigned long long Bytes = 0;
    int Is = Content;
    int From = 0;
  };
  void SendHeader(int to, Kind kind, std::size_t bytes);
  void SendMessage(int to, const Message& message);
  Message ReceiveMessage(int from);
  void Drop(int from, unsigned long long count);
  void EndRun(const Message& reason);
  Message GatherPacked(Message message);
  std::vector<int> RanksBelow() const;

  Traffic SentSoFar;

  std::vector<char> HasFailed; ///< By rank: its failure has arrived.
  std::vector<char> Dropped;   ///< What nobody wants any more is read to here.
};

/** One rank alone, as a program without MPI has it. */
class SingleRank final : public Communicator
{
public:
  int Rank() const override { return 0; }
  int NumberOfRanks() const override { return 1; }

protected:
  void Send(int, const void*, std::size_t) override {}
  void Receive(int, void*, std::size_t) override {}
  void ReceiveFromAny(void*, std::size_t) override {}
};

/** A rank that has no others to ask. */
inline Communicator& OnThisRank()
{
  static SingleRank rank;
  return rank;
}

/** Puts values and arrays of plain types into a message. */
class MessageWriter
{
public:
  template <typename T>
  void Add(const T& value)
  {
    static_assert(std::is_trivially_copyable<T>::value, "bytes are all that is sent");
    const char* bytes = reinterpret_cast<const char*>(&value);
    this->Content.insert(this->Content.end(), bytes, bytes + sizeof(T));
  }
  template <typename Array>
  void AddArray(const Array& values)
  {
    using T = typename Array::value_type;
    static_assert(std::is_trivially_copyable<T>::value, "bytes are all that is sent");
    this->Add(static_cast<unsigned long long>(values.size()));
    const char* bytes = reinterpret_cast<const char*>(values.data());
    this->Content.insert(this->Content.end(), bytes, bytes + values.size() * sizeof(T));
  }
  Message Take() { return std::move(this->Content); }

private:
  Message Content;
};

/** Takes values and arrays out of a message, in the order in which they were put in. */
class MessageReader
{
public:
  explicit MessageReader(const Message& message)
    : Content(message)
  {
  }
  bool IsAtEnd() const { return this->Place == this->Content.size(); }
  template <typename T>
  T Take()
  {
    T value;
    this->Copy(&value, sizeof(T));
    return value;
  }
  template <typename Array>
  void TakeArray(Array& values)
  {
    values.resize(static_cast<std::size_t>(this->Take<unsigned long long>()));
    this->Copy(values.data(), values.size() * sizeof(typename Array::value_type));
  }
  template <typename T>
  std::vector<T> TakeVector()
  {
    std::vector<T> values;
    this->TakeArray(values);
    return values;
  }

private:
  void Copy(void* to, std::size_t count)
  {
    if (count > this->Content.size() - this->Place)
    {
      throw std::logic_error("A message of another rank is shorter than expected.");
    }
    if (count > 0)
    {
      std::memcpy(to, this->Content.data() + this->Place, count);
    }
    this->Place += count;
  }

  const Message& Content;
  std::size_t Place = 0;
};

/** @return the values of all ranks, by rank. */
template <typename T>
std::vector<T> GatherValues(Communicator& ranks, const T& value)
{
  MessageWriter writer;
  writer.Add(value);
  std::vector<T> values;
  for (const Message& message : ranks.GatherOnAll(writer.Take()))
  {
    values.push_back(MessageReader(message).Take<T>());
  }
  return values;
}

/** @return the value of rank 0. */
template <typename T>
T BroadcastValue(Communicator& ranks, const T& value)
{
  MessageWriter writer;
  writer.Add(value);
  return MessageReader(ranks.Broadcast(writer.Take())).Take<T>();
}
}

#endif
