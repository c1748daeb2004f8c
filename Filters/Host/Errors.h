// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicErrors_h
#define volumicErrors_h

#include "Core/Common/Refuse.h"

#include <functional>
#include <stdexcept>
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

/** An error as SetErrorCode and vtkErrorMacro get it. */
struct AlgorithmError
{
  unsigned long Code = 0; ///< 0: there is none
  std::string Text;
};

/**
 * Does the work of RequestData. Where it throws, all outputs are left initialised: no data half
 * made, and none of the field data that the pipeline has passed from the input. RequestData then
 * returns 1 all the same: after 0 the pipeline would print a second error, and ParaView's clients
 * would keep what they had before.
 * @param aboutMemory what to say where the memory does not suffice
 * @return what it throws: vtkErrorCode::UserError for std::invalid_argument (what was given is
 *         wrong), else vtkErrorCode::UnknownError (memory).
 */
AlgorithmError RunAlgorithm(vtkInformationVector* outputs,
  const std::function<std::string()>& aboutMemory, const std::function<void()>& work);

/**
 * What the work gives; what it refuses (Refuse.h) is refused with the place in front, so that the
 * message names it: `Input port 0: `.
 * @throws std::invalid_argument as the work does; other exceptions pass as they are.
 */
template <typename Work>
auto PrefixErrors(const std::string& place, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const std::invalid_argument& error)
  {
    Refuse(place, error.what());
  }
}
}

#endif
