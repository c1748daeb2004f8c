// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/** No tag of VTK or ParaView: they count from 1, and from 100, 8000 and 99990. */
constexpr int Tag = 22095;

/** Between two words on how far it is. */
constexpr std::chrono::milliseconds Interval(100);

/**
 * Those that have heard it sleep for a while: MPI waits with all the power of a processor, which
 * the threads of the first rank can use.
 */
constexpr std::chrono::milliseconds Nap(80);

/** What comes with an answer is an error. */
constexpr int Failed = -1;

bool WorkTogether(
  vtkMultiProcessController* controller, vtkInformation* request, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* info = output->GetInformationObject(port);
  return controller && controller->GetNumberOfProcesses() > 1 &&
    info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == controller->GetNumberOfProcesses() &&
    info->Get(Pipeline::UPDATE_PIECE_NUMBER()) == controller->GetLocalProcessId();
}

RankMessage MessageOf(const AlgorithmError& error)
{
  RankMessage message;
  message.Words << static_cast<vtkTypeUInt64>(error.Code) << error.Text;
  return message;
}

AlgorithmError ErrorOf(RankMessage& message)
{
  vtkTypeUInt64 code = 0;
  AlgorithmError error;
  message.Words >> code >> error.Text;
  error.Code = static_cast<unsigned long>(code);
  return error;
}
}

Ranks::Ranks(vtkMultiProcessController* controller, vtkInformation* request,
  vtkInformationVector* output, Show show)
  : Controller(WorkTogether(controller, request, output) ? controller : nullptr),
    ShowHere(std::move(show)), IsAsked(static_cast<std::size_t>(this->Count()), false),
    Told(Clock::now())
{
}

int Ranks::Rank() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

int Ranks::Count() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

void Ranks::Send(int to, int word, const RankMessage& message)
{
  RankMessage head;
  head.Words << word;
  head.Send(this->Controller, to, Tag);
  message.Send(this->Controller, to, Tag);
}

RankMessage Ranks::Receive(int from, int& word)
{
  RankMessage head;
  head.Receive(this->Controller, from, Tag);
  head.Words >> word;
  RankMessage message;
  message.Receive(this->Controller, from, Tag);
  return message;
}

RankMessage Ranks::Hear(int rank)
{
  int word = 0;
  RankMessage message = this->Receive(rank, word);
  this->IsAsked[static_cast<std::size_t>(rank)] = false;
  if (word == Failed)
  {
    throw ToldError(ErrorOf(message));
  }
  return message;
}

void Ranks::HearOthers()
{
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    if (this->IsAsked[static_cast<std::size_t>(rank)])
    {
      bool stops = false;
      this->Hear(rank).Words >> stops;
      this->IsStopped = this->IsStopped || stops;
    }
  }
}

RankMessage Ranks::Ask(int rank, RankQuestion question, const RankMessage& message)
{
  this->HearOthers();
  this->Send(rank, static_cast<int>(question), message);
  this->IsAsked[static_cast<std::size_t>(rank)] = true;
  return this->Hear(rank);
}

std::vector<RankMessage> Ranks::AskAll(RankQuestion question, const RankMessage& message)
{
  this->HearOthers();
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    this->Send(rank, static_cast<int>(question), message);
    this->IsAsked[static_cast<std::size_t>(rank)] = true;
  }
  std::vector<RankMessage> answers(1);
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    answers.push_back(this->Hear(rank));
  }
  return answers;
}

bool Ranks::GoOn(double share, const std::string& text)
{
  const bool goesOn = this->ShowHere(share, text);
  if (this->AreMany() && Clock::now() - this->Told > Interval)
  {
    this->HearOthers();
    RankMessage message;
    message.Words << share << text;
    for (int rank = 1; rank < this->Count(); ++rank)
    {
      this->Send(rank, static_cast<int>(RankQuestion::Progress), message);
      this->IsAsked[static_cast<std::size_t>(rank)] = true;
    }
    this->Told = Clock::now();
  }
  return goesOn && !this->IsStopped;
}

void Ranks::End()
{
  this->HearOthers();
  this->AreWaiting = false;
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    this->Send(rank, static_cast<int>(RankQuestion::End));
  }
}

void Ranks::Fail(const AlgorithmError& error)
{
  if (!this->IsFirst() || !std::exchange(this->AreWaiting, false))
  {
    return;
  }
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    int word = 0;
    if (this->IsAsked[static_cast<std::size_t>(rank)])
    {
      this->Receive(rank, word); // It is not wanted any more.
    }
    this->Send(rank, static_cast<int>(RankQuestion::Fail), MessageOf(error));
  }
}

void Ranks::Serve(const Answer& answer, const std::function<std::string()>& aboutMemory)
{
  for (;;)
  {
    int word = 0;
    RankMessage message = this->Receive(0, word);
    const auto question = static_cast<RankQuestion>(word);
    if (question == RankQuestion::End)
    {
      return;
    }
    if (question == RankQuestion::Fail)
    {
      throw ToldError(ErrorOf(message));
    }
    RankMessage own;
    const AlgorithmError error = CatchError(aboutMemory,
      [&]
      {
        if (question != RankQuestion::Progress)
        {
          own = answer(question, message);
          return;
        }
        double share = 0.0;
        std::string text;
        message.Words >> share >> text;
        own.Words << !this->ShowHere(share, text);
      });
    const bool hasFailed = error.Code != 0;
    this->Send(0, hasFailed ? Failed : word, hasFailed ? MessageOf(error) : own);
    if (question == RankQuestion::Progress || question == RankQuestion::OwnProgress)
    {
      std::this_thread::sleep_for(Nap);
    }
  }
}
}
