// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHostThreads_h
#define volumicHostThreads_h

#include "Core/Common/Executor.h"
#include "vtkFiltersVolumicModule.h" // for the export macro

#include <functional>
#include <memory>
#include <string>

namespace volumic
{
/**
 * The threads of the host program, through vtkSMPTools, for the core.
 *
 * The host's backend is used as it is (TBB in Debian's VTK). Only where that is sequential by
 * default, as in Debian's ParaView, threads of the standard library are used instead; a user who
 * wants it sequential all the same sets VTK_SMP_BACKEND_IN_USE=Sequential or asks for one thread.
 * Instead of VTK's backend STDThread, which ends the program where the system denies it a thread,
 * our own StandardThreads serve; VTK itself is sequential meanwhile.
 */
class VTKFILTERSVOLUMIC_EXPORT HostThreads final : public Executor
{
public:
  /** @param numberOfThreads 0 = all that the host has; never more than there are processors. */
  explicit HostThreads(int numberOfThreads);

  /**
   * For measurements and tests: what is made from now on hands all that Run() does to this executor
   * instead of the host's threads; null, as at first: to these. Not while a filter runs.
   */
  static void UseInstead(Executor* executor);

  /**
   * Runs `work`, within which For() may be called; choosing a backend has its price, which is paid
   * here once.
   */
  void Run(const std::function<void()>& work);

  /**
   * @see Executor. Outside Run() everything is done on the calling thread. With a limit of memory
   * (ScratchMemory) in smaller steps, between which it is kept.
   */
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body) override;
  bool MakeVisits(const VisitSchedule& schedule, const VisitBody& visit) override;
  void EndPhase(const char* name) override;

private:
  void Share(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body);
  void RunWithin(
    const std::string& backend, int numberOfThreads, const std::function<void()>& work);

  int NumberOfThreads;
  std::string Backend;
  std::unique_ptr<Executor> Own; ///< instead of the backend, within Run()
  Executor* Instead; ///< null: none
  bool Running = false;
};
}

#endif
