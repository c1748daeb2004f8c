// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VtkMessages.h"

#include "ToolErrors.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>

namespace tool
{
namespace
{
/// "ERROR: In file, line 1\nvtkClass (0x1): the message\n\n" becomes "the message".
std::string PlainMessage(const std::string& text)
{
  const std::size_t colon = text.find("): ");
  const std::string message = colon == std::string::npos ? text : text.substr(colon + 3);
  std::string plain;
  for (const char c : message)
  {
    const bool isSpace = c == ' ' || c == '\n' || c == '\r' || c == '\t';
    if (!isSpace)
    {
      plain += c;
    }
    else if (!plain.empty() && plain.back() != ' ')
    {
      plain += ' ';
    }
  }
  while (!plain.empty() && plain.back() == ' ')
  {
    plain.pop_back();
  }
  return plain;
}

class MessageObserver : public vtkCommand
{
public:
  static MessageObserver* New() { return new MessageObserver; }

  void Execute(vtkObject*, unsigned long event, void* data) override
  {
    const std::string text = PlainMessage(data ? static_cast<const char*>(data) : "");
    (event == vtkCommand::ErrorEvent ? this->Messages->Errors : this->Messages->Warnings)
      .push_back(text);
  }

  VtkMessages* Messages = nullptr;
};
}

void VtkMessages::ListenTo(vtkAlgorithm* algorithm)
{
  vtkNew<MessageObserver> observer;
  observer->Messages = this;
  for (vtkObject* object :
    { static_cast<vtkObject*>(algorithm), static_cast<vtkObject*>(algorithm->GetExecutive()) })
  {
    object->AddObserver(vtkCommand::ErrorEvent, observer);
    object->AddObserver(vtkCommand::WarningEvent, observer);
  }
}

void VtkMessages::UpdateReader(vtkAlgorithm* reader, const std::string& name)
{
  this->ListenTo(reader);
  reader->Update();
  if (!this->Errors.empty() || reader->GetErrorCode() != 0)
  {
    const std::string reason = this->JoinedErrors();
    throw Failure(name + ": cannot be read (" + (reason.empty() ? "damaged file" : reason) + ")");
  }
}

std::string VtkMessages::JoinedErrors() const
{
  std::string joined;
  for (const std::string& error : this->Errors)
  {
    joined += (joined.empty() ? "" : "; ") + error;
  }
  return joined;
}
}
