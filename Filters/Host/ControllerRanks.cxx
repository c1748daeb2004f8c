// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/ControllerRanks.h"

#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkType.h>

#include <algorithm>
#include <stdexcept>

namespace volumic
{
namespace
{
/** No tag of VTK or ParaView: they count from 1, and from 100, 8000 and 99990. */
constexpr int Tag = 22095;
}

ControllerRanks::ControllerRanks(vtkMultiProcessController* controller) : Controller(controller) {}

ControllerRanks::~ControllerRanks() = default;

int ControllerRanks::Rank() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

int ControllerRanks::NumberOfRanks() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

void ControllerRanks::Send(int to, const void* bytes, std::size_t count)
{
  const auto length = static_cast<vtkIdType>(count);
  if (!this->Controller->Send(static_cast<const char*>(bytes), length, to, Tag))
  {
    throw std::runtime_error("A message to another process could not be sent.");
  }
}

void ControllerRanks::Receive(int from, void* bytes, std::size_t count)
{
  const auto length = static_cast<vtkIdType>(count);
  if (!this->Controller->Receive(static_cast<char*>(bytes), length, from, Tag))
  {
    throw std::runtime_error("A message of another process could not be received.");
  }
}

void ControllerRanks::ReceiveFromAny(void* bytes, std::size_t count)
{
  this->Receive(vtkMultiProcessController::ANY_SOURCE, bytes, count);
}

std::unique_ptr<Communicator> RanksOf(
  vtkMultiProcessController* controller, vtkInformation* request, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  auto all = std::make_unique<ControllerRanks>(controller);
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* info = output->GetInformationObject(port);
  const bool isPieceOfEach = info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) ==
      all->NumberOfRanks() && info->Get(Pipeline::UPDATE_PIECE_NUMBER()) == all->Rank();
  if (all->NumberOfRanks() > 1 && isPieceOfEach)
  {
    return all;
  }
  return std::make_unique<SingleRank>();
}
}
