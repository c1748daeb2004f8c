// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunWriter.h"

#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkNew.h>

namespace tool
{
namespace
{
class WriterObserver : public vtkCommand
{
public:
  static WriterObserver* New() { return new WriterObserver; }

  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    this->Line->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress(), "");
  }

  ProgressLine* Line = nullptr;
};
}

void RunWriter(vtkAlgorithm* writer, const std::function<void()>& write, ProgressLine& line)
{
  VtkMessages messages;
  messages.ListenTo(writer);
  vtkNew<WriterObserver> observer;
  observer->Line = &line;
  writer->AddObserver(vtkCommand::ProgressEvent, observer);
  messages.Catch(write);
  if (!messages.Errors.empty() || writer->GetErrorCode() != 0)
  {
    const std::string reason = messages.JoinedErrors();
    throw Failure("cannot be written (" + (reason.empty() ? "is the disk full?" : reason) + ")");
  }
}
}
