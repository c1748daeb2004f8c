// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRanks_h
#define volumicRanks_h

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkMultiProcessController;

namespace tool
{
/**
 * The processes that mpirun has started to work on one surface; where it has not, or the program
 * was built without MPI, this process alone, for which all of these do nothing.
 *
 * All ranks make the same calls in the same order. What may fail on one of them is done within
 * Together(), and nothing that waits for other ranks beside a filter's update.
 */
class Ranks
{
public:
  /** Joins the other ranks, if there are any. */
  Ranks(int& argc, char**& argv);

  /** Waits for the other ranks. */
  ~Ranks();

  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int Rank() const;
  int Count() const;
  bool IsFirst() const { return this->Rank() == 0; }
  bool IsOne() const { return this->Count() == 1; }

  /**
   * Do the work on each rank.
   * @throws what it throws on one rank, of the same words, on all ranks: UsageError,
   * std::bad_alloc, else a Failure. If several fail, the lowest tells why; not the first rank, it is named.
   */
  void Together(const std::function<void()>& work);

  /** Likewise, on the first rank only. */
  void OnFirst(const std::function<void()>& work);

  /** Throw what has failed on any rank, as Together() does. @param failure empty: nothing here */
  void ThrowAny(const std::string& failure);

  /** Throw a failure that all ranks have found. */
  [[noreturn]] void ThrowOnAll(const std::string& words);

  /** Whether the exception that is under way has been thrown on all ranks. */
  bool HaveAgreed() const { return this->IsAgreed; }

  /** End the program on all ranks: one has met what the others don't know of. */
  void Abort(int code);

  /** Update a filter: all of it, or the piece of this rank. */
  void Update(vtkAlgorithm* filter) const;

  bool IsAny(bool isHere) const;

  /** What the first rank has. */
  std::string Broadcast(std::string bytes) const;
  double Broadcast(double value) const;

  /**
   * Lists that all ranks should have alike: where one differs from that of the first rank, `refuse`
   * is called there, to throw, with the items that differ. Empty: there is nothing more.
   */
  void NeedSame(const std::vector<std::string>& here,
    const std::function<void(const std::string& here, const std::string& first)>& refuse);

  /** What each rank has, on all ranks. */
  std::vector<std::string> GatherOnAll(const std::string& bytes) const;
  std::vector<double> GatherOnAll(double number) const;

  /** To the first rank, which calls Receive() meanwhile. */
  void SendToFirst(vtkDataObject* data) const;
  void Receive(vtkDataObject* data, int from) const;

private:
  void Agree(int kind, std::string words);

  vtkSmartPointer<vtkMultiProcessController> Controller; ///< null: alone
  bool IsAgreed = false;
};
}

#endif
