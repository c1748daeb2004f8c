// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicErrors_h
#define volumicErrors_h

#include "Core/Common/Refuse.h"

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkInformationVector;

namespace volumic
{
/**
 * Does the work of RequestData, and reports what it throws as an error of the filter. Then all
 * outputs are left initialised: no data half made, and none of the field data that the pipeline has
 * passed from the input. RequestData returns 1 all the same: after 0 the pipeline would print a
 * second error, and ParaView's clients would keep what they had before.
 * @param place       what messages begin with
 * @param aboutMemory what to say where the memory does not suffice
 * @return for SetErrorCode(): vtkErrorCode::NoError; UserError for a Refusal (what was given is
 *         wrong); else UnknownError (memory)
 */
unsigned long RunAlgorithm(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::string& place, const std::function<std::string()>& aboutMemory,
  const std::function<void()>& work);

/**
 * What the work gives; what it refuses (Refuse.h) is refused with the place in front, so that the
 * message names it: `Input port 0: `.
 * @throws Refusal as the work does; other exceptions pass as they are.
 */
template <typename Work>
auto PrefixErrors(const std::string& place, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const Refusal& error)
  {
    Refuse(place, error.what());
  }
}
}

#endif
