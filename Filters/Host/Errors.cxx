// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/Errors.h"

#include "Host/Pipeline.h"

#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkInformationVector.h>

#include <new>
#include <stdexcept>

namespace volumic
{
unsigned long RunAlgorithm(vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::string& prefix, const std::function<std::string()>& memoryMessage,
  const std::function<void()>& work)
{
  // ParaView does not reset the flag of an earlier run.
  ForgetAbort(filter);
  unsigned long code = vtkErrorCode::NoError;
  std::string text;
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    const bool isInvalid = dynamic_cast<const InvalidArgument*>(&error) != nullptr;
    code = isInvalid ? vtkErrorCode::UserError : vtkErrorCode::UnknownError;
    text = dynamic_cast<const std::bad_alloc*>(&error) ? memoryMessage() : error.what();
  }
  if (code != vtkErrorCode::NoError)
  {
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
      {
        output->Initialize();
      }
    }
    vtkErrorWithObjectMacro(filter, << prefix << text);
  }
  ForgetAbort(filter);
  return code;
}
}
