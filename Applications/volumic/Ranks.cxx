// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks.h"

#include <vtkAlgorithm.h>
#include <vtkMultiProcessController.h>
#ifdef VOLUMIC_HAS_MPI
#include <vtkMPIController.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace tool
{
namespace
{
/** Of what the first one tells the others: an exit code, the last word, or that they are to help.
 */
constexpr int WordTag = 22101;
constexpr int Help = -1;

/** Of what an interrupted one tells the first. */
constexpr int StopTag = 22102;

/** MPI waits with all the power of a processor: so it is only looked at now and then. */
constexpr std::chrono::milliseconds Nap(50);

#ifdef VOLUMIC_HAS_MPI
/** Whether mpirun has started this process, or what a cluster has in its place. */
bool IsStartedByMpi()
{
  // Open MPI, MPICH and its kin, and what starts either by PMIx (srun --mpi=pmix).
  const auto names = { "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "PMIX_RANK",
    "PMI_RANK" };
  return std::any_of(
    names.begin(), names.end(), [](const char* name) { return std::getenv(name) != nullptr; });
}
#endif
}

Ranks::Ranks([[maybe_unused]] int& argc, [[maybe_unused]] char**& argv)
{
#ifdef VOLUMIC_HAS_MPI
  if (IsStartedByMpi())
  {
    auto controller = vtkSmartPointer<vtkMPIController>::New();
    controller->Initialize(&argc, &argv);
    this->Controller = controller;
    vtkMultiProcessController::SetGlobalController(controller);
  }
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

bool Ranks::Take([[maybe_unused]] int tag, [[maybe_unused]] int& word)
{
  int isThere = 0;
#ifdef VOLUMIC_HAS_MPI
  int from = 0;
  if (auto* mpi = vtkMPIController::SafeDownCast(this->Controller))
  {
    mpi->Iprobe(vtkMultiProcessController::ANY_SOURCE, tag, &isThere, &from);
    isThere = isThere != 0 && mpi->Receive(&word, 1, from, tag) != 0;
  }
#endif
  return isThere != 0;
}

int Ranks::Wait(const std::function<bool()>& isInterrupted, const std::function<void()>& help)
{
  for (int word = Help;;)
  {
    if (!this->IsInterrupted && isInterrupted())
    {
      this->IsInterrupted = true;
      this->Controller->Send(&word, 1, 0, StopTag);
    }
    if (!this->Take(WordTag, word))
    {
      std::this_thread::sleep_for(Nap);
    }
    else if (word != Help)
    {
      return word;
    }
    else
    {
      help();
    }
  }
}

bool Ranks::AreInterrupted()
{
  int word = 0;
  this->IsInterrupted = this->IsInterrupted || (this->IsFirst() && this->Take(StopTag, word));
  return this->IsInterrupted;
}

void Ranks::Tell(int word)
{
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    this->Controller->Send(&word, 1, rank, WordTag);
  }
}

void Ranks::End(int code)
{
  for (int word = 0; this->Take(StopTag, word);)
  {
  }
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
  filter->UpdatePiece(this->Controller->GetLocalProcessId(), this->Count(), 0);
}
}
