// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVtkMessages_h
#define volumicVtkMessages_h

#include <vtkSmartPointer.h>

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
}

#endif
