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
 * Execute the work of RequestData(). Report an exception as an error of the filter, and initialize
 * all outputs.
 *
 * RequestData() must return 1 also after an error. After 0 the pipeline reports a second error, and
 * ParaView's clients keep the data of the last run.
 * @param prefix        prefix of the message
 * @param memoryMessage returns the message for std::bad_alloc
 * @return the code for SetErrorCode(): vtkErrorCode::NoError, UserError for InvalidArgument,
 *   UnknownError for other exceptions
 */
unsigned long RunAlgorithm(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::string& prefix, const std::function<std::string()>& memoryMessage,
  const std::function<void()>& work);

/**
 * Return the result of the work. Prefix the message of an InvalidArgument that it throws, such as
 * with `Input port 0: `.
 */
template <typename Work>
auto PrefixErrors(const std::string& prefix, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const InvalidArgument& error)
  {
    ThrowInvalidArgument(prefix, error.what());
  }
}
}

#endif
