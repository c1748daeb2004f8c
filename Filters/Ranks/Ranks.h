// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRanks_h
#define volumicRanks_h

#include "Host/AlgorithmErrors.h"
#include "Ranks/RankMessage.h"

#include <vtkMultiProcessController.h>
#include <vtkSmartPointer.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

class vtkInformation;
class vtkInformationVector;

namespace volumic
{
/** What the first rank asks of the others. */
enum class RankQuestion : int
{
  End,      ///< All is done, or what has ended the run. No answer.
  Progress, ///< How far it is; is it to stop?
  Frames,   ///< Of which images are there parts? (RankInputs.h)
  Part,
  Points,
  Output,     ///< Take this. (RankOutputs.h)
  Own,        ///< What the filter has made up itself.
  OwnProgress ///< Likewise, while the others work. As after Progress, they sleep for a while.
};

/**
 * The processes that make the output of a filter together. The first one makes it, with its
 * threads: it asks the others, one question at a time, for what they have of the inputs, and hands
 * them their parts of the outputs; they do nothing but answer (Serve). What fails on any of them
 * fails on all, at the latest with the next question, and is told once.
 */
class Ranks
{
public:
  /** Shows how far the run is, on this rank; false asks to stop. */
  using Show = std::function<bool(double share, const std::string& text)>;
  /** At the others; may throw. */
  using Answer = std::function<RankMessage(RankQuestion question, RankMessage& message)>;

  /**
   * Those of the controller where each asks for the piece of its own number, of as many pieces as
   * there are ranks, as ParaView has them do. Else one rank alone: who asks for a piece gets it as
   * from a program without MPI.
   * @param controller may be null
   * @param request, output as RequestUpdateExtent and RequestData have them
   */
  Ranks(vtkMultiProcessController* controller, vtkInformation* request,
    vtkInformationVector* output, Show show = {});

  int Rank() const;
  int Count() const;
  bool IsFirst() const { return this->Rank() == 0; }
  bool AreMany() const { return this->Count() > 1; }

  // At the first rank.

  /** Asks one of the others. @throws ToldError */
  RankMessage Ask(int rank, RankQuestion question, const RankMessage& message = {});
  /** Asks all of them at once. @return by rank; that of the first is empty */
  std::vector<RankMessage> AskAll(RankQuestion question, const RankMessage& message = {});
  /**
   * As often as one likes; several times a second the others hear it, too, who answer when they are
   * told again. @return false where any rank has asked to stop
   */
  bool GoOn(double share, const std::string& text);
  /** Whether another rank has asked to stop. */
  bool IsStoppedByOthers() const { return this->IsStopped; }
  /** Lets the others go, with the error that has ended the run, if any. */
  void End(const AlgorithmError& error);

  /**
   * At the others: answers until the first rank says that all is done.
   * @param aboutMemory see RunAlgorithm
   * @throws ToldError as the first rank has told.
   */
  void Serve(const Answer& answer, const std::function<std::string()>& aboutMemory);

private:
  using Clock = std::chrono::steady_clock;
  void Put(int rank, RankQuestion question, const RankMessage& message);
  RankMessage Hear(int rank);
  void HearOthers();

  vtkSmartPointer<vtkMultiProcessController> Controller; ///< null: alone
  Show ShowHere;
  std::vector<bool> IsAsked; ///< by rank: an answer is on its way
  bool IsStopped = false;
  Clock::time_point Told; ///< When the others heard last.
};
}

#endif
