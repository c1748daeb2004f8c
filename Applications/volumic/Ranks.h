// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolRanks_h
#define volumicToolRanks_h

#include <vtkSmartPointer.h>

#include <functional>

class vtkAlgorithm;
class vtkMultiProcessController;

namespace tool
{
/**
 * The processes that mpirun has started; where it has not, or the program was built without MPI,
 * this process alone. The first one does all work, as without mpirun; the others wait, and help
 * with labels.
 */
class Ranks
{
public:
  /** Joins the other ranks, if there are any. */
  Ranks(int& argc, char**& argv);

  /** Waits for the other ranks. */
  ~Ranks();

  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int Count() const;
  bool IsFirst() const;

  /**
   * At the others, until the first one is through.
   * @param isInterrupted asked now and then; once it is, the first one is told
   * @param help          updates what the first one updates
   * @return the exit code of the first one
   */
  int Wait(const std::function<bool()>& isInterrupted, const std::function<void()>& help);

  // At the first one:

  /** Whether another rank was interrupted, which it tells. */
  bool AreInterrupted();

  /** Lets the others go. */
  void End(int code);

  // At all:

  /** Updates a filter together with the others, which Wait() at first. */
  void Update(vtkAlgorithm* filter);

private:
  /** Whether there is a word, which it then takes. */
  bool Take(int tag, int& word);
  void Tell(int word);

  vtkSmartPointer<vtkMultiProcessController> Controller; ///< null: alone
  bool IsInterrupted = false;
};
}

#endif
