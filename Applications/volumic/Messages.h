// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMessages_h
#define volumicMessages_h

#include <vtkSmartPointer.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkCallbackCommand;

namespace tool
{
/** Keeps the errors and warnings of VTK objects, which would go to stderr with file and line. */
class VtkMessages
{
public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /** An error of an algorithm that does not say why. */
  static constexpr const char* Untold = "it failed";

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;

  /** Listen to an algorithm and its executive, as long as this object is there. */
  void ListenTo(vtkAlgorithm* algorithm);

  /**
   * Update the reader of the file, or, with an extent, that part.
   * @throws Failure "NAME: cannot be read (reasons)" if it, or an
   * object within it, reports an error; or warns, unless its warnings are not `trusted`.
   */
  void UpdateReader(vtkAlgorithm* reader, const std::string& name, bool trusted = true,
    const int* extent = nullptr);

  /** Have the reader look at what the file is about. @throws Failure as above if it complains. */
  void AskReader(vtkAlgorithm* reader, const std::string& name);

  /**
   * Run the action; what VTK would print meanwhile, for objects that nobody listens to, is kept.
   */
  void Catch(const std::function<void()>& action);

  /** @throws Failure "NAME: cannot be read (reasons)" if there was an error. */
  void ThrowErrors(const std::string& name) const;

  /** Each error once, with semicolons between. */
  std::string JoinedErrors() const;

private:
  std::vector<vtkSmartPointer<vtkCallbackCommand>> Observers;
};

/**
 * Tell of a file that is opened what is not followed, or had to be guessed, in one line with both
 * values: a warning of VTK's, which ParaView shows, and the program with the file's name.
 */
void TellOfFile(const std::string& text);

// ---- Progress -----------------------------------------------------------------------------------

/** How the progress is shown on stderr. */
enum class ProgressStyle
{
  None,
  OneLine, ///< one line that is drawn anew: a terminal
  Lines    ///< a line for each tenth
};

/** The progress of one piece of work, on stderr. The line of a terminal goes with it. */
class ProgressLine
{
public:
  ProgressLine(const std::string& title, ProgressStyle style);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /** `share` of the work is done, 0 to 1. */
  void Show(double share, const std::string& text);

private:
  void Redraw(double share, const std::string& text);

  std::string Title;
  ProgressStyle Style;
  bool IsDrawn = false;
  std::chrono::steady_clock::time_point DrawnAt;
  double NextShare = 0.0;
};
}

#endif
