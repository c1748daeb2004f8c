// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/Errors.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>

#include <new>
#include <stdexcept>

namespace volumic
{
std::string CollectErrors(vtkAlgorithm* algorithm, const std::function<void()>& run)
{
  std::string errors;
  vtkNew<vtkCallbackCommand> collect;
  collect->SetClientData(&errors);
  collect->SetCallback(
    [](vtkObject*, unsigned long, void* client, void* message)
    {
      std::string text = static_cast<const char*>(message);
      // `ERROR: In file, line 1\nvtkClass (0x1): what is wrong\n\n`
      const std::size_t speaker = text.find("): ");
      text.erase(0, speaker == std::string::npos ? 0 : speaker + 3);
      text.erase(text.find_last_not_of('\n') + 1);
      *static_cast<std::string*>(client) += text;
    });

  const unsigned long ofAlgorithm = algorithm->AddObserver(vtkCommand::ErrorEvent, collect);
  const unsigned long ofExecutive =
    algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, collect);
  run();
  algorithm->RemoveObserver(ofAlgorithm);
  algorithm->GetExecutive()->RemoveObserver(ofExecutive);
  return errors;
}

namespace
{
AlgorithmError CatchError(
  const std::function<std::string()>& aboutMemory, const std::function<void()>& work)
{
  try
  {
    work();
    return {};
  }
  catch (const std::bad_alloc&)
  {
    return { vtkErrorCode::UnknownError, aboutMemory() };
  }
  catch (const std::invalid_argument& refused)
  {
    return { vtkErrorCode::UserError, refused.what() };
  }
  catch (const std::exception& other)
  {
    return { vtkErrorCode::UnknownError, other.what() };
  }
}
}

AlgorithmError RunAlgorithm(vtkInformationVector* outputs,
  const std::function<std::string()>& aboutMemory, const std::function<void()>& work)
{
  const AlgorithmError error = CatchError(aboutMemory, work);
  for (int port = 0; error.Code != 0 && port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
  return error;
}
}
