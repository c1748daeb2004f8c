// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks.h"

#include "ToolErrors.h"

#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkMultiProcessController.h>
#ifdef VOLUMIC_HAS_MPI
#include <vtkMPIController.h>
#include <vtk_mpi.h>
#endif

#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <new>
#include <sstream>
#include <utility>

namespace tool
{
namespace
{
constexpr int DataTag = 22101;

/** What was thrown. */
enum Kind : int
{
  Nothing,
  OfUsage,
  OfMemory,
  Other
};

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

[[noreturn]] void Throw(int kind, const std::string& words)
{
  switch (kind)
  {
    case OfUsage:
      throw UsageError(words);
    case OfMemory:
      throw std::bad_alloc();
    default:
      throw Failure(words);
  }
}

#ifdef VOLUMIC_HAS_MPI
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

int Ranks::Rank() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

int Ranks::Count() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

void Ranks::Together(const std::function<void()>& work)
{
  if (this->IsOne())
  {
    work();
    return;
  }
  this->IsAgreed = false;
  int kind = Nothing;
  std::string words;
  try
  {
    work();
  }
  catch (const UsageError& error)
  {
    kind = OfUsage;
    words = error.what();
  }
  catch (const std::bad_alloc&)
  {
    kind = OfMemory;
  }
  catch (const std::exception& error)
  {
    kind = Other;
    words = error.what();
  }
  this->Agree(kind, std::move(words));
}

void Ranks::Agree(int kind, std::string words)
{
  if (!this->IsAny(kind != Nothing))
  {
    return;
  }
  const std::vector<std::string> all =
    this->GatherOnAll(std::string(1, static_cast<char>(kind)) + words);
  for (int rank = 0; rank < this->Count(); ++rank)
  {
    const std::string& told = all[static_cast<std::size_t>(rank)];
    if (told[0] != Nothing)
    {
      this->IsAgreed = true;
      const std::string who = rank == 0 ? "" : "rank " + std::to_string(rank) + ": ";
      Throw(told[0], who + told.substr(1));
    }
  }
}

void Ranks::ThrowAny(const std::string& failure)
{
  this->Together(
    [&failure]
    {
      FailIf(!failure.empty(), failure);
    });
}

void Ranks::ThrowOnAll(const std::string& words)
{
  this->IsAgreed = true;
  throw Failure(words);
}

void Ranks::OnFirst(const std::function<void()>& work)
{
  this->Together(
    [&]
    {
      if (this->IsFirst())
      {
        work();
      }
    });
}

void Ranks::Abort(int code)
{
#ifdef VOLUMIC_HAS_MPI
  if (this->Controller)
  {
    MPI_Abort(MPI_COMM_WORLD, code);
  }
#else
  (void)code;
#endif
}

void Ranks::Update(vtkAlgorithm* filter) const
{
  if (this->IsOne())
  {
    filter->Update();
  }
  else
  {
    filter->UpdatePiece(this->Rank(), this->Count(), 0);
  }
}

bool Ranks::IsAny(bool isHere) const
{
  if (this->IsOne())
  {
    return isHere;
  }
  const int here = isHere ? 1 : 0;
  int any = here;
  this->Controller->AllReduce(&here, &any, 1, vtkCommunicator::MAX_OP);
  return any != 0;
}

std::string Ranks::Broadcast(std::string bytes) const
{
  if (!this->IsOne())
  {
    auto size = static_cast<vtkIdType>(bytes.size());
    this->Controller->Broadcast(&size, 1, 0);
    bytes.resize(static_cast<std::size_t>(size));
    this->Controller->Broadcast(bytes.data(), size, 0);
  }
  return bytes;
}

double Ranks::Broadcast(double value) const
{
  if (!this->IsOne())
  {
    this->Controller->Broadcast(&value, 1, 0);
  }
  return value;
}

void Ranks::NeedSame(const std::vector<std::string>& here,
  const std::function<void(const std::string& here, const std::string& first)>& refuse)
{
  std::string joined;
  for (const std::string& item : here)
  {
    joined += item + '\0';
  }
  std::istringstream first(this->Broadcast(joined));
  this->Together(
    [&]
    {
      std::string ofFirst;
      for (const std::string& item : here)
      {
        const bool isThere = static_cast<bool>(std::getline(first, ofFirst, '\0'));
        if (!isThere || item != ofFirst)
        {
          refuse(item, isThere ? ofFirst : "");
        }
      }
      if (std::getline(first, ofFirst, '\0'))
      {
        refuse("", ofFirst);
      }
    });
}

std::vector<std::string> Ranks::GatherOnAll(const std::string& bytes) const
{
  if (this->IsOne())
  {
    return { bytes };
  }
  const auto count = static_cast<std::size_t>(this->Count());
  const auto size = static_cast<vtkIdType>(bytes.size());
  std::vector<vtkIdType> sizes(count);
  this->Controller->AllGather(&size, sizes.data(), 1);
  std::vector<vtkIdType> begins(count + 1, 0);
  for (std::size_t rank = 0; rank < count; ++rank)
  {
    begins[rank + 1] = begins[rank] + sizes[rank];
  }
  std::string joined(static_cast<std::size_t>(begins[count]), '\0');
  this->Controller->AllGatherV(bytes.data(), joined.data(), size, sizes.data(), begins.data());
  std::vector<std::string> all;
  for (std::size_t rank = 0; rank < count; ++rank)
  {
    all.push_back(joined.substr(
      static_cast<std::size_t>(begins[rank]), static_cast<std::size_t>(sizes[rank])));
  }
  return all;
}

std::vector<double> Ranks::GatherOnAll(double number) const
{
  std::vector<double> all(static_cast<std::size_t>(this->Count()), number);
  if (!this->IsOne())
  {
    this->Controller->AllGather(&number, all.data(), 1);
  }
  return all;
}

void Ranks::SendToFirst(vtkDataObject* data) const
{
  this->Controller->Send(data, 0, DataTag);
}

void Ranks::Receive(vtkDataObject* data, int from) const
{
  this->Controller->Receive(data, from, DataTag);
}
}
