// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFirstRankWork_h
#define volumicFirstRankWork_h

#include "Core/Common/Communicator.h"

#include <chrono>
#include <functional>
#include <string>

namespace volumic
{
/**
 * Work that rank 0 does alone, while the other ranks wait for its end. Now and then they hear how
 * far it is, and whether one of them wants it to stop. One rank alone just works.
 */
class FirstRankWork
{
public:
  /** Shows how far the run is, on this rank; false asks to stop. */
  using Show = std::function<bool(double share, const std::string& text)>;

  FirstRankWork(Communicator& ranks, Show show);

  /**
   * All ranks call it; it returns on all when the work is done. What the work throws must become
   * Communicator::Fail(), then the others leave it, too.
   * @param help what the others do for rank 0, while it is in OnAllRanks()
   */
  void Run(const std::function<void()>& work, const std::function<void()>& help = {});

  /** From within the work at rank 0: what all ranks do, it by `work`, the others by `help`. */
  void OnAllRanks(const std::function<void()>& work);

  /**
   * From within the work at rank 0, as often as it likes; outside of Run(), on any rank, without a
   * word to the others. @return false where one of them has asked to stop
   */
  bool GoOn(double share, const std::string& text);

  /** Whether another rank has asked rank 0 to stop. */
  bool IsStoppedByOthers() const { return this->IsStopped; }

private:
  using Clock = std::chrono::steady_clock;
  void Wait(const std::function<void()>& help);
  bool Tell(double share, const std::string& text);

  Communicator& Ranks;
  Show ShowHere;
  bool OthersWait = false;
  bool IsStopped = false;
  Clock::time_point Told; ///< When the others heard last.
};
}

#endif
