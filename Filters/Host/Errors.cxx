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
  const std::string& place, const std::function<std::string()>& aboutMemory,
  const std::function<void()>& work)
{
  // ParaView leaves the flag of an earlier run as it is.
  ForgetAbort(filter);
  unsigned long code = vtkErrorCode::NoError;
  std::string text;
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    code = vtkErrorCode::UnknownError;
    text = aboutMemory();
  }
  catch (const InvalidArgument& refused)
  {
    code = vtkErrorCode::UserError;
    text = refused.what();
  }
  catch (const std::exception& other)
  {
    code = vtkErrorCode::UnknownError;
    text = other.what();
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
    vtkErrorWithObjectMacro(filter, << place << text);
  }
  ForgetAbort(filter);
  return code;
}
}
