// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks.h"

#include <vtkAlgorithm.h>
#include <vtkMultiProcessController.h>
#ifdef VOLUMIC_HAS_MPI
#include <vtkMPIController.h>
#endif

#include <cstdlib>
#include <initializer_list>
#include <thread>
#include <utility>

namespace tool
{
namespace
{
constexpr int Tag = 22101;

/** What the first one tells the others; what is not negative is an exit code, the last word. */
enum Word : int
{
  Ask = -1,
  Help = -2
};

constexpr std::chrono::milliseconds Interval(100);

/** MPI waits with all the power of a processor; whoever has answered sleeps for a while. */
constexpr std::chrono::milliseconds Nap(80);

#ifdef VOLUMIC_HAS_MPI
/** The value of the first of these in the environment; null: there is none. */
const char* FirstOf(std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    if (const char* value = std::getenv(name))
    {
      return value;
    }
  }
  return nullptr;
}

/** Whether mpirun, or what a cluster has in its place, has started this process and others. */
bool AreMany()
{
  // Open MPI, MPICH and its kin, and what starts either by PMIx (srun --mpi=pmix). One process that
  // was started so has no others to join.
  const char* count = FirstOf({ "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE" });
  return count ? std::atoi(count) > 1 : FirstOf({ "PMIX_RANK", "PMI_RANK" }) != nullptr;
}
#endif
}

Ranks::Ranks(int& argc, char**& argv)
{
#ifdef VOLUMIC_HAS_MPI
  if (AreMany())
  {
    auto controller = vtkSmartPointer<vtkMPIController>::New();
    controller->Initialize(&argc, &argv);
    this->Controller = controller;
    vtkMultiProcessController::SetGlobalController(controller);
  }
#else
  (void)argc;
  (void)argv;
#endif
}

Ranks::~Ranks()
{
  if (this->Controller)
  {
    vtkMultiProcessController::SetGlobalController(nullptr);
    this->Controller->Finalize();
  }
}

int Ranks::Count() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

bool Ranks::IsFirst() const
{
  return !this->Controller || this->Controller->GetLocalProcessId() == 0;
}

int Ranks::Wait(
  const std::function<bool()>& isInterrupted, const std::function<void()>& help)
{
  for (;;)
  {
    int word = 0;
    this->Controller->Receive(&word, 1, 0, Tag);
    if (word >= 0)
    {
      return word;
    }
    if (word == Help)
    {
      help();
      continue;
    }
    const int answer = isInterrupted() ? 1 : 0;
    this->Controller->Send(&answer, 1, 0, Tag);
    std::this_thread::sleep_for(Nap);
  }
}

void Ranks::Hear()
{
  for (int rank = 1; this->IsAsked && rank < this->Count(); ++rank)
  {
    int answer = 0;
    this->Controller->Receive(&answer, 1, rank, Tag);
    this->IsInterrupted = this->IsInterrupted || answer != 0;
  }
  this->IsAsked = false;
}

void Ranks::Tell(int word)
{
  this->Hear();
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    this->Controller->Send(&word, 1, rank, Tag);
  }
}

bool Ranks::AreInterrupted()
{
  const auto now = std::chrono::steady_clock::now();
  if (this->Controller && this->IsFirst() && !this->IsUpdating && now - this->Told > Interval)
  {
    this->Tell(Ask);
    this->IsAsked = true;
    this->Told = now;
  }
  return this->IsInterrupted;
}

void Ranks::End(int code)
{
  this->Tell(code);
}

void Ranks::Update(vtkAlgorithm* filter)
{
  if (!this->Controller)
  {
    filter->Update();
    return;
  }
  if (this->IsFirst())
  {
    this->Tell(Help);
  }
  this->IsUpdating = true;
  filter->UpdatePiece(this->Controller->GetLocalProcessId(), this->Count(), 0);
  this->IsUpdating = false;
}
}
