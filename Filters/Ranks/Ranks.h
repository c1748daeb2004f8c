// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRanks_h
#define volumicRanks_h

#include "Host/Errors.h"
#include "Ranks/RankMessage.h"

#include <vtkMultiProcessController.h>
#include <vtkSmartPointer.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;
class vtkPolyData;

namespace volumic
{
/** What RequestData and RequestUpdateExtent of a filter are given. */
struct FilterCall
{
  vtkAlgorithm* Filter;
  vtkInformation* Request;
  vtkInformationVector** Inputs;
  vtkInformationVector* Outputs;
};

/** What the first rank asks of the others. */
enum class RankQuestion : int
{
  End,      ///< All is done, or what has ended the run. No answer.
  Progress, ///< How far it is; is it to stop?
  Frames,   ///< Of which images are there parts?
  Part,
  Points,
  Output, ///< Take this.
  Own ///< What the filter has made up itself.
};

/** What becomes of the outputs that the first rank has made. */
enum class Dealing
{
  InPieces,   ///< Each rank gets its piece (Pieces.h), with the ghosts that are asked for.
  FirstHasAll ///< The others get surfaces without points, and blocks of the same names.
};

/** What the ranks of a filter do in RequestData. */
struct RankWork
{
  /** Takes the inputs, fills the outputs. */
  std::function<void()> OfFirst;
  /** Answers RankQuestion::Own; may be empty, and may throw. */
  std::function<RankMessage(RankMessage& message)> OfOthers;
  Dealing Deals = Dealing::InPieces;
};

/**
 * The processes that make the output of a filter together. The first one makes it, with its
 * threads: it asks the others, one question at a time, for what they have of the inputs, and hands
 * them their parts of the outputs; they do nothing but answer. What fails on any of them fails on
 * all, at the latest with the next question, and is told once.
 */
class Ranks
{
public:
  /** Shows how far the run is, on this rank; false asks to stop. */
  using Show = std::function<bool(double share, const std::string& text)>;

  /**
   * Those of the controller where each asks for the piece of its own number, of as many pieces as
   * there are ranks, as ParaView has them do. Else one rank alone: who asks for a piece gets it as
   * from a program without MPI.
   * @param controller may be null
   */
  Ranks(vtkMultiProcessController* controller, const FilterCall& call, Show show = {});

  int Rank() const;
  int Count() const;
  bool IsFirst() const { return this->Rank() == 0; }
  bool AreMany() const { return this->Count() > 1; }

  /**
   * RequestUpdateExtent: where ranks work together each asks all inputs for its piece, as sources
   * that cannot give pieces give the first one all; else the first process asks for the whole.
   */
  void AskForInputs() const;

  /**
   * RequestData, by all ranks: the first one works, then each gets its part of the outputs. One
   * rank alone works and keeps all.
   * @param aboutMemory see RunAlgorithm
   * @return what to report, the same on all ranks
   */
  AlgorithmError Run(const std::function<std::string()>& aboutMemory, const RankWork& work);

  // At the first rank, in its work. ToldError is thrown where another one has failed.

  /**
   * The images at an input port of which ranks have pieces, whole, in memory that may be scratch
   * memory; of a pyramid's levels all. What this rank has all of is as it came.
   * @throws std::invalid_argument if they don't lie in one image, or leave voxels out; where one
   * has something else.
   */
  vtkSmartPointer<vtkDataObject> TakeImages(int port);
  /** Likewise, of a surface, or of points (JoinSurfaces). Null where nobody has any. */
  vtkSmartPointer<vtkPolyData> TakePoints(int port);

  /** Asks one of the others. */
  RankMessage Ask(int rank, RankQuestion question, const RankMessage& message = {});
  /** Asks all of them at once. @return from rank 1 on */
  std::vector<RankMessage> AskAll(RankQuestion question, const RankMessage& message = {});
  /**
   * As often as one likes; several times a second the others hear it, too.
   * @return false where any rank has asked to stop
   */
  bool GoOn(double share, const std::string& text);
  /** Whether another rank has asked to stop. */
  bool IsStoppedByOthers() const { return this->IsStopped; }

private:
  using Clock = std::chrono::steady_clock;
  std::vector<RankMessage> AskSome(
    int first, int end, RankQuestion question, const RankMessage& message);
  void Deal(Dealing deals);
  void Serve(const std::function<std::string()>& aboutMemory, const RankWork& work);
  RankMessage Answer(RankQuestion question, RankMessage& message, const RankWork& work) const;
  RankMessage GiveInput(RankQuestion question, RankMessage& message) const;

  FilterCall Call;
  vtkSmartPointer<vtkMultiProcessController> Controller; ///< null: alone
  Show ShowHere;
  bool IsStopped = false;
  Clock::time_point Told; ///< When the others heard last.
};
}

#endif
