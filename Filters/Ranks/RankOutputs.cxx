// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankOutputs.h"

#include "Host/WholeInput.h"
#include "Ranks/CutData.h"

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
  const bool isWhole = deals == Dealing::FirstHasAll;
  Cut cut{ 0, ranks.Count(), GhostLevelsAskedOf(call.Request, call.Outputs), isWhole };
  for (int port = 0; port < call.Outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(call.Outputs, port);
    for (cut.Number = 1; cut.Number < cut.Count; ++cut.Number)
    {
      RankMessage part;
      part.Words << port;
      part.Put(CutData(output, cut).Get());
      ranks.Ask(cut.Number, RankQuestion::Output, part);
    }
    cut.Number = 0;
    vtkSmartPointer<vtkDataObject> own = output;
    if (!isWhole)
    {
      own = CutData(output, cut);
    }
    if (own != output)
    {
      output->ShallowCopy(own);
    }
  }
}

/** At another rank. */
RankMessage TakeOutput(RankMessage& message, vtkInformationVector* outputs)
{
  int port = 0;
  message.Words >> port;
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
      if (ranks.AreMany())
      {
        Deal(ranks, call, work.Deals);
        ranks.End();
      }
    });
  if (error.Code != 0)
  {
    ranks.Fail(error);
  }
  return error;
}
}
