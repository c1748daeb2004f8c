// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Messages.h"

#include "ToolErrors.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include <sys/ioctl.h>
#include <unistd.h>

namespace tool
{
namespace
{
/** "ERROR: In file, line 1\nvtkClass (0x1): the message\n\n" becomes "the message". */
std::string PlainMessage(const std::string& text)
{
  const std::size_t colon = text.find("): ");
  const bool hasPlaceOnly = text.compare(0, 20, "Generic Warning: In ") == 0;
  const std::string message = hasPlaceOnly ? text.substr(std::min(text.find('\n'), text.size()))
    : colon == std::string::npos           ? text
                                           : text.substr(colon + 3);
  std::istringstream words(message);
  std::string plain;
  for (std::string word; words >> word;)
  {
    plain += (plain.empty() ? "" : " ") + word;
  }
  return plain;
}

/** Keep an error, but not the executive's that its algorithm failed, which has said why. */
void KeepError(const std::string& text, std::vector<std::string>& errors)
{
  const bool isEcho = text.find("returned failure for request") != std::string::npos;
  if (!isEcho || errors.empty())
  {
    errors.push_back(isEcho ? VtkMessages::Untold : text);
  }
}

/** An error or a warning, to the messages that listen; null: they have ended. */
void KeepMessage(vtkObject*, unsigned long event, void* listening, void* data)
{
  if (auto* messages = static_cast<VtkMessages*>(listening))
  {
    const std::string text = PlainMessage(data ? static_cast<const char*>(data) : "");
    event == vtkCommand::ErrorEvent ? KeepError(text, messages->Errors)
                                    : messages->Warnings.push_back(text);
  }
}

/** Takes what VTK prints for objects that nobody listens to, such as the parts of a reader. */
class OutputCatcher : public vtkOutputWindow
{
public:
  static OutputCatcher* New() { return new OutputCatcher; }

  void DisplayErrorText(const char* text) override
  {
    KeepError(Plain(text), this->Messages->Errors);
  }
  void DisplayWarningText(const char* text) override
  {
    this->Messages->Warnings.push_back(Plain(text));
  }
  void DisplayGenericWarningText(const char* text) override { this->DisplayWarningText(text); }

  VtkMessages* Messages = nullptr;

private:
  static std::string Plain(const char* text) { return PlainMessage(text ? text : ""); }
};

/** From here to its end, what VTK would print is among the messages. */
class CaughtOutput
{
public:
  explicit CaughtOutput(VtkMessages& messages)
    : Former(vtkOutputWindow::GetInstance()), Verbosity(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF); // it prints what it hands on
    vtkNew<OutputCatcher> catcher;
    catcher->Messages = &messages;
    vtkOutputWindow::SetInstance(catcher);
  }
  ~CaughtOutput()
  {
    vtkOutputWindow::SetInstance(this->Former);
    vtkLogger::SetStderrVerbosity(this->Verbosity);
  }
  CaughtOutput(const CaughtOutput&) = delete;
  CaughtOutput& operator=(const CaughtOutput&) = delete;

private:
  vtkSmartPointer<vtkOutputWindow> Former;
  vtkLogger::Verbosity Verbosity;
};
}

VtkMessages::VtkMessages() = default;

VtkMessages::~VtkMessages()
{
  for (const auto& observer : this->Observers)
  {
    observer->SetClientData(nullptr);
  }
}

void VtkMessages::ListenTo(vtkAlgorithm* algorithm)
{
  const auto observer = vtkSmartPointer<vtkCallbackCommand>::New();
  observer->SetClientData(this);
  observer->SetCallback(KeepMessage);
  this->Observers.push_back(observer);
  for (vtkObject* object :
    { static_cast<vtkObject*>(algorithm), static_cast<vtkObject*>(algorithm->GetExecutive()) })
  {
    object->AddObserver(vtkCommand::ErrorEvent, observer);
    object->AddObserver(vtkCommand::WarningEvent, observer);
  }
}

void VtkMessages::UpdateReader(
  vtkAlgorithm* reader, const std::string& name, bool trusted, const int* extent)
{
  this->ListenTo(reader);
  const auto update = [&]
  {
    // After an error in the header some of VTK's readers go on, and crash.
    reader->UpdateInformation();
    if (this->Errors.empty() && extent)
    {
      reader->UpdateExtent(extent);
    }
    else if (this->Errors.empty())
    {
      reader->Update();
    }
  };
  try
  {
    this->Catch(update);
  }
  catch (const std::logic_error& error)
  {
    this->Errors.emplace_back(error.what()); // Of the standard library: a text or an array is none.
  }
  if (trusted)
  {
    // What a reader warns of are data that it lacked and made up.
    this->Errors.insert(this->Errors.end(), this->Warnings.begin(), this->Warnings.end());
  }
  if (this->Errors.empty() && reader->GetErrorCode() != 0)
  {
    this->Errors.emplace_back("damaged file");
  }
  this->ThrowErrors(name);
}

void VtkMessages::AskReader(vtkAlgorithm* reader, const std::string& name)
{
  this->ListenTo(reader);
  this->Catch([&] { reader->UpdateInformation(); });
  this->ThrowErrors(name);
}

void VtkMessages::ThrowErrors(const std::string& name) const
{
  FailIf(!this->Errors.empty(), name + ": cannot be read (" + this->JoinedErrors() + ")");
}

void VtkMessages::Catch(const std::function<void()>& action)
{
  const CaughtOutput caught(*this);
  action();
}

std::string VtkMessages::JoinedErrors() const
{
  std::string joined;
  for (auto error = this->Errors.begin(); error != this->Errors.end(); ++error)
  {
    const bool isNew = std::find(this->Errors.begin(), error, *error) == error;
    joined += !isNew ? "" : (joined.empty() ? "" : "; ") + *error;
  }
  return joined;
}

void TellOfFile(const std::string& text)
{
  vtkGenericWarningMacro(<< text);
}

// ---- Progress -----------------------------------------------------------------------------------

namespace
{
/** Columns of the terminal behind stderr. */
std::size_t TerminalWidth()
{
  winsize size{};
  const bool isKnown = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return isKnown ? size.ws_col : 80;
}
}

ProgressLine::ProgressLine(const std::string& title, ProgressStyle style)
  : Title(title), Style(style)
{
}

ProgressLine::~ProgressLine()
{
  if (this->IsDrawn)
  {
    std::fprintf(stderr, "\r%*s\r", static_cast<int>(TerminalWidth() - 1), "");
  }
}

void ProgressLine::Show(double share, const std::string& text)
{
  share = std::clamp(share, 0.0, 1.0);
  if (this->Style == ProgressStyle::OneLine)
  {
    this->Redraw(share, text);
  }
  else if (this->Style == ProgressStyle::Lines && share >= this->NextShare)
  {
    const std::string more = text.empty() ? "" : "  " + text;
    std::fprintf(stderr, "%s: %3.0f %%%s\n", this->Title.c_str(), 100.0 * share, more.c_str());
    this->NextShare = share + 0.1;
  }
}

void ProgressLine::Redraw(double share, const std::string& text)
{
  const auto now = std::chrono::steady_clock::now();
  if (this->IsDrawn && now - this->DrawnAt < std::chrono::milliseconds(100))
  {
    return;
  }
  this->IsDrawn = true;
  this->DrawnAt = now;
  const std::size_t barWidth = 24;
  const auto filled = static_cast<std::size_t>(share * barWidth);
  char percent[16];
  std::snprintf(percent, sizeof(percent), "%3.0f %% ", 100.0 * share);
  std::string line = this->Title + " [" + std::string(filled, '#') +
    std::string(barWidth - filled, '.') + "] " + percent + text;
  line.resize(TerminalWidth() - 1, ' '); // a longer one would leave its rests
  std::fprintf(stderr, "\r%s", line.c_str());
  std::fflush(stderr);
}
}
