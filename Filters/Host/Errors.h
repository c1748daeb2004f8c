// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicErrors_h
#define volumicErrors_h

#include "Core/Common/ThrowInvalidArgument.h"

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkInformationVector;

namespace volumic
{
/**
 * Execute the work of RequestData, and report an exception as an error of the filter. All outputs
 * are then initialized, without partial data and without the field data of the input.
 *
 * RequestData must return 1 after an error, too. After 0 the pipeline prints a second error, and
 * the clients of ParaView keep the data of the run before.
 * @param place       prefix of the message
 * @param aboutMemory returns the message for std::bad_alloc
 * @return the code for SetErrorCode(): vtkErrorCode::NoError, UserError for a Refusal (invalid
 *         input or property), UnknownError for other exceptions
 */
unsigned long RunAlgorithm(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::string& place, const std::function<std::string()>& aboutMemory,
  const std::function<void()>& work);

/**
 * Return the result of the work. A Refusal gets the place as the prefix of its message, such as
 * `Input port 0: `. Other exceptions are not changed.
 */
template <typename Work>
auto PrefixErrors(const std::string& place, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const InvalidArgument& error)
  {
    ThrowInvalidArgument(place, error.what());
  }
}
}

#endif
