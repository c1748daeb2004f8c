// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicAlgorithmErrors_h
#define volumicAlgorithmErrors_h

#include "Core/Common/Communicator.h"

#include <exception>
#include <functional>
#include <string>

class vtkAlgorithm;
class vtkInformationVector;

namespace volumic
{
/**
 * What an algorithm, or its executive, reports as an error while something runs; it is not printed,
 * and is without the place in the source. Empty if all went well.
 */
std::string CollectErrors(vtkAlgorithm* algorithm, const std::function<void()>& run);

/**
 * What a filter's SetErrorCode gets for what ended its run: vtkErrorCode::UserError for
 * std::invalid_argument (what was given is wrong), else vtkErrorCode::UnknownError (memory).
 */
unsigned long ErrorCodeOf(const std::exception& error);

/** An error as SetErrorCode and vtkErrorMacro get it. */
struct AlgorithmError
{
  unsigned long Code;
  std::string Text;
};

/** What Communicator::Fail() tells the other ranks, so that they report the same error. */
std::string ReasonOf(const AlgorithmError& error);

/** What that was made of. */
AlgorithmError ErrorOf(const OtherRankFailed& failure);

/**
 * Leaves all outputs initialised, after an error: no data half made, and none of the field data
 * that the pipeline has passed from the input. RequestData then returns 1 all the same: after 0 the
 * pipeline would print a second error, and ParaView's clients would keep what they had before.
 */
void InitializeOutputs(vtkInformationVector* outputs);
}

#endif
