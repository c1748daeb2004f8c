// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include "Host/Pipeline.h"
#include "Ranks/Pieces.h"

#include <vtkDataObject.h>
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
 * Those that have heard it sleep for a while, but are awake before they are told again: MPI waits
 * with all the power of a processor, which the threads of the first rank can use.
 */
constexpr std::chrono::milliseconds Nap(80);

/** What comes with an answer is an error. */
constexpr int Failed = -1;

bool WorkTogether(vtkMultiProcessController* controller, const FilterCall& call)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* info = AskedOutput(call.Request, call.Outputs);
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
    ShowHere(std::move(show)), Told(Clock::now())
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

std::vector<RankMessage> Ranks::AskSome(
  int first, int end, RankQuestion question, const RankMessage& message)
{
  for (int rank = first; rank < end; ++rank)
  {
    message.Send(this->Controller, rank, static_cast<int>(question));
  }
  std::vector<RankMessage> answers;
  RankMessage* failure = nullptr;
  answers.reserve(static_cast<std::size_t>(this->Count()));
  for (int rank = first; rank < end; ++rank)
  {
    RankMessage& answer = answers.emplace_back();
    const bool hasFailed = answer.Receive(this->Controller, rank) == Failed;
    failure = hasFailed && !failure ? &answer : failure;
  }
  if (failure) // Not before all have answered.
  {
    throw ToldError(ErrorOf(*failure));
  }
  return answers;
}

RankMessage Ranks::Ask(int rank, RankQuestion question, const RankMessage& message)
{
  return this->AskSome(rank, rank + 1, question, message).front();
}

std::vector<RankMessage> Ranks::AskAll(RankQuestion question, const RankMessage& message)
{
  return this->AskSome(1, this->Count(), question, message);
}

bool Ranks::GoOn(double share, const std::string& text)
{
  const bool goesOn = this->ShowHere(share, text);
  if (this->AreMany() && Clock::now() - this->Told > Interval)
  {
    RankMessage message;
    message << share << text;
    for (RankMessage& answer : this->AskAll(RankQuestion::Progress, message))
    {
      bool stops = false;
      answer >> stops;
      this->IsStopped = this->IsStopped || stops;
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
    MessageOf(error).Send(this->Controller, rank, static_cast<int>(RankQuestion::End));
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
    if (question == RankQuestion::Progress)
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
      return work.OfOthers(message);
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
