// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include "Host/WholeInput.h"
#include "Ranks/Pieces.h"

#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>

namespace volumic
{
namespace
{
/** Between two words on how far it is. */
constexpr std::chrono::milliseconds Interval(100);

/**
 * Those that have heard it sleep for a while: MPI waits with all the power of a processor, which
 * the threads of the first rank can use.
 */
constexpr std::chrono::milliseconds Nap(80);

/** What comes with an answer is an error. */
constexpr int Failed = -1;

bool WorkTogether(vtkMultiProcessController* controller, const FilterCall& call)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const int port = std::max(0, call.Request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* info = call.Outputs->GetInformationObject(port);
  return controller && controller->GetNumberOfProcesses() > 1 &&
    info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == controller->GetNumberOfProcesses() &&
    info->Get(Pipeline::UPDATE_PIECE_NUMBER()) == controller->GetLocalProcessId();
}

RankMessage MessageOf(const AlgorithmError& error)
{
  RankMessage message;
  message << error.Code << error.Text;
  return message;
}

AlgorithmError ErrorOf(RankMessage& message)
{
  AlgorithmError error;
  message >> error.Code >> error.Text;
  return error;
}
}

Ranks::Ranks(vtkMultiProcessController* controller, const FilterCall& call, Show show)
  : Call(call), Controller(WorkTogether(controller, call) ? controller : nullptr),
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

void Ranks::Put(int rank, RankQuestion question, const RankMessage& message)
{
  message.Send(this->Controller, rank, static_cast<int>(question));
  this->IsAsked[static_cast<std::size_t>(rank)] = question != RankQuestion::End;
}

RankMessage Ranks::Hear(int rank)
{
  RankMessage message;
  const int word = message.Receive(this->Controller, rank);
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
      this->Hear(rank) >> stops;
      this->IsStopped = this->IsStopped || stops;
    }
  }
}

RankMessage Ranks::Ask(int rank, RankQuestion question, const RankMessage& message)
{
  this->HearOthers();
  this->Put(rank, question, message);
  return this->Hear(rank);
}

std::vector<RankMessage> Ranks::AskAll(RankQuestion question, const RankMessage& message)
{
  this->HearOthers();
  for (int rank = 1; rank < this->Count(); ++rank)
  {
    this->Put(rank, question, message);
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
    message << share << text;
    for (int rank = 1; rank < this->Count(); ++rank)
    {
      this->Put(rank, RankQuestion::Progress, message);
    }
    this->Told = Clock::now();
  }
  return goesOn && !this->IsStopped;
}

AlgorithmError Ranks::Run(const std::function<std::string()>& aboutMemory, const RankWork& work)
{
  const AlgorithmError error = RunAlgorithm(this->Call.Outputs, aboutMemory,
    [&]
    {
      if (!this->IsFirst())
      {
        this->Serve(aboutMemory, work);
        return;
      }
      work.OfFirst();
      this->Deal(work.Deals);
    });
  for (int rank = 1; this->IsFirst() && rank < this->Count(); ++rank)
  {
    if (this->IsAsked[static_cast<std::size_t>(rank)])
    {
      RankMessage().Receive(this->Controller, rank); // It is not wanted any more.
    }
    this->Put(rank, RankQuestion::End, MessageOf(error));
  }
  return error;
}

/** Gives the others their parts of the outputs, and leaves the first one its own. */
void Ranks::Deal(Dealing deals)
{
  const bool isWhole = deals == Dealing::FirstHasAll || !this->AreMany();
  Cut cut{ 0, this->Count(), GhostLevelsAskedOf(this->Call.Request, this->Call.Outputs), isWhole };
  for (int port = 0; port < this->Call.Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(this->Call.Outputs, port);
    for (cut.Number = 1; cut.Number < cut.Count; ++cut.Number)
    {
      RankMessage part;
      part << port;
      part.Put(CutData(output, cut));
      this->Ask(cut.Number, RankQuestion::Output, part);
    }
    cut.Number = 0;
    if (!isWhole)
    {
      output->ShallowCopy(CutData(output, cut));
    }
  }
}

/** Answers until the first rank says that all is done. */
void Ranks::Serve(const std::function<std::string()>& aboutMemory, const RankWork& work)
{
  for (;;)
  {
    RankMessage message;
    const int word = message.Receive(this->Controller, 0);
    const auto question = static_cast<RankQuestion>(word);
    if (question == RankQuestion::End)
    {
      const AlgorithmError error = ErrorOf(message);
      return error.Code != 0 ? throw ToldError(error) : void();
    }
    RankMessage own;
    const AlgorithmError error =
      CatchError(aboutMemory, [&] { own = this->Answer(question, message, work); });
    const bool hasFailed = error.Code != 0;
    (hasFailed ? MessageOf(error) : own).Send(this->Controller, 0, hasFailed ? Failed : word);
    if (question == RankQuestion::Progress || question == RankQuestion::OwnProgress)
    {
      std::this_thread::sleep_for(Nap);
    }
  }
}

RankMessage Ranks::Answer(RankQuestion question, RankMessage& message, const RankWork& work) const
{
  RankMessage answer;
  switch (question)
  {
    case RankQuestion::Own:
    case RankQuestion::OwnProgress:
      return work.OfOthers(question, message);
    case RankQuestion::Output:
    {
      int port = 0;
      message >> port;
      vtkDataObject::GetData(this->Call.Outputs, port)->ShallowCopy(message.TakeData());
      return answer;
    }
    case RankQuestion::Progress:
    {
      double share = 0.0;
      std::string text;
      message >> share >> text;
      answer << !this->ShowHere(share, text);
      return answer;
    }
    default:
      return this->GiveInput(question, message);
  }
}
}
