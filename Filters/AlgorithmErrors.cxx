// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AlgorithmErrors.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>

namespace volumic
{
std::string UpdateAndCollectErrors(vtkAlgorithm* algorithm)
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
  // The executive says only that the algorithm has failed.
  vtkNew<vtkCallbackCommand> ignore;
  ignore->SetCallback([](vtkObject*, unsigned long, void*, void*) {});

  const unsigned long collecting = algorithm->AddObserver(vtkCommand::ErrorEvent, collect);
  const unsigned long ignoring =
    algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, ignore);
  algorithm->Update();
  algorithm->RemoveObserver(collecting);
  algorithm->GetExecutive()->RemoveObserver(ignoring);
  return errors;
}
}
