// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankOutputs.h"

#include "Host/WholeInput.h"
#include "Ranks/Pieces.h"

#include <vtkDataObject.h>
#include <vtkInformationVector.h>
#include <vtkSmartPointer.h>

namespace volumic
{
namespace
{
/** Gives the others their parts of the outputs, and leaves the first one its own. */
void Deal(Ranks& ranks, const FilterCall& call, Dealing deals)
{
  const bool isWhole = deals == Dealing::FirstHasAll || !ranks.AreMany();
  Cut cut{ 0, ranks.Count(), GhostLevelsAskedOf(call.Request, call.Outputs), isWhole };
  for (int port = 0; port < call.Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(call.Outputs, port);
    for (cut.Number = 1; cut.Number < cut.Count; ++cut.Number)
    {
      RankMessage part;
      part << port;
      part.Put(CutData(output, cut));
      ranks.Ask(cut.Number, RankQuestion::Output, part);
    }
    cut.Number = 0;
    if (!isWhole)
    {
      output->ShallowCopy(CutData(output, cut));
    }
  }
}

/** At another rank. */
RankMessage TakeOutput(RankMessage& message, vtkInformationVector* outputs)
{
  int port = 0;
  message >> port;
  vtkDataObject::GetData(outputs, port)->ShallowCopy(message.TakeData());
  return {};
}
}

AlgorithmError RunOnRanks(Ranks& ranks, const FilterCall& call,
  const std::function<std::string()>& aboutMemory, const RankWork& work)
{
  const auto answer = [&](RankQuestion question, RankMessage& message)
  {
    switch (question)
    {
      case RankQuestion::Own:
      case RankQuestion::OwnProgress:
        return work.OfOthers(question, message);
      case RankQuestion::Output:
        return TakeOutput(message, call.Outputs);
      default:
        return AnswerForInputs(question, message, call);
    }
  };
  const AlgorithmError error = RunAlgorithm(call.Outputs, aboutMemory,
    [&]
    {
      if (!ranks.IsFirst())
      {
        ranks.Serve(answer, aboutMemory);
        return;
      }
      work.OfFirst();
      Deal(ranks, call, work.Deals);
    });
  if (ranks.IsFirst())
  {
    ranks.End(error);
  }
  return error;
}
}
