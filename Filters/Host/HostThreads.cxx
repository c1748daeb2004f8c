// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/HostThreads.h"

#include "Core/Common/ScratchMemory.h"
#include "Core/Common/StandardThreads.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace volumic
{
namespace
{
constexpr const char* StandardBackend = "STDThread";

/** See HostThreads::UseInstead. */
Executor* theInstead = nullptr;

/** More threads than processors gain nothing, and TBB complains. */
int LimitToProcessors(int numberOfThreads)
{
  const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  return processors > 0 ? std::min(numberOfThreads, processors) : numberOfThreads;
}

std::string ChooseBackend(int numberOfThreads)
{
  const std::string host = vtkSMPTools::GetBackend();
  const char* chosen = std::getenv("VTK_SMP_BACKEND_IN_USE");
  const bool isChosenByUser = chosen && std::string(chosen) == "Sequential";
  if (host == "Sequential" && !isChosenByUser && numberOfThreads != 1)
  {
    return StandardBackend;
  }
  return host;
}

/** The backends let exceptions end the program: the first one is kept and thrown again. */
class Body
{
public:
  explicit Body(const std::function<void(std::size_t, std::size_t)>& function) : Function(function)
  {
  }

  void operator()(vtkIdType begin, vtkIdType end)
  {
    try
    {
      this->Function(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      if (!this->Exception)
      {
        this->Exception = std::current_exception();
      }
    }
  }

  void Rethrow() const
  {
    if (this->Exception)
    {
      std::rethrow_exception(this->Exception);
    }
  }

private:
  const std::function<void(std::size_t, std::size_t)>& Function;
  std::mutex Mutex;
  std::exception_ptr Exception;
};
}

HostThreads::HostThreads(int numberOfThreads)
  : NumberOfThreads(LimitToProcessors(numberOfThreads))
  , Backend(ChooseBackend(numberOfThreads))
  , Instead(theInstead)
{
}

void HostThreads::UseInstead(Executor* executor)
{
  theInstead = executor;
}

void HostThreads::RunWithin(
  const std::string& backend, int numberOfThreads, const std::function<void()>& work)
{
  // What is thrown must not pass through VTK's scope, which would not restore the backend.
  std::exception_ptr exception;
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ numberOfThreads, backend, false },
    [&]
    {
      try
      {
        work();
      }
      catch (...)
      {
        exception = std::current_exception();
      }
    });
  if (exception)
  {
    std::rethrow_exception(exception);
  }
}

void HostThreads::Run(const std::function<void()>& work)
{
  if (this->NumberOfThreads == 1 && !this->Instead)
  {
    work();
    return;
  }
  const auto run = [&]
  {
    this->Running = true;
    try
    {
      work();
    }
    catch (...)
    {
      this->Running = false;
      throw;
    }
    this->Running = false;
  };
  if (this->Instead)
  {
    run();
    return;
  }
  if (this->Backend != StandardBackend)
  {
    this->RunWithin(this->Backend, this->NumberOfThreads, run);
    return;
  }
  int number = 1;
  this->RunWithin(this->Backend, this->NumberOfThreads,
    [&] { number = vtkSMPTools::GetEstimatedNumberOfThreads(); });
  this->Own = std::make_unique<StandardThreads>(number);
  this->RunWithin("Sequential", 1, run);
  this->Own.reset();
}

void HostThreads::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (n == 0)
  {
    return;
  }
  if (!HasMemoryLimit())
  {
    this->Share(n, grain, body);
    return;
  }
  // Room is waited for step by step, however large the level is: an item that looks at a voxel or
  // two may bring in 16 pages with each, so that 12,000 of them are more than all that is free.
  const std::size_t step = std::max(grain / 8, std::size_t(1));
  this->Share(n, grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (; begin < end; begin += step)
      {
        KeepMemoryLimit();
        body(begin, std::min(end, begin + step));
      }
    });
}

void HostThreads::Share(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (this->Running && this->Instead)
  {
    this->Instead->For(n, grain, body);
    return;
  }
  if (!this->Running || n <= grain)
  {
    body(0, n);
    return;
  }
  if (this->Own)
  {
    this->Own->For(n, grain, body);
    return;
  }
  Body guarded(body);
  vtkSMPTools::For(0, static_cast<vtkIdType>(n), static_cast<vtkIdType>(grain), guarded);
  guarded.Rethrow();
}

bool HostThreads::MakeVisits(const VisitSchedule& schedule, const VisitBody& visit)
{
  return this->Instead && this->Instead->MakeVisits(schedule, visit);
}

void HostThreads::EndPhase(const char* name)
{
  if (this->Instead)
  {
    this->Instead->EndPhase(name);
  }
}
}
