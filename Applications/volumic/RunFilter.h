// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunFilter_h
#define volumicRunFilter_h

#include "Messages.h"

#include <string>
#include <vector>

class vtkAlgorithm;

namespace tool
{
class Ranks;

struct FilterRun
{
  double Seconds = 0.0;
  std::vector<std::string> Warnings;
  bool IsInterrupted = false;
};

/**
 * From here on Ctrl-C (SIGINT) and SIGTERM set the AbortExecute of the filter that runs, so that it
 * hands over what it has; the second one ends the program at once, as usual. With many ranks
 * SIGUSR1 does so too: mpirun hands it on, and does not kill the ranks a second later.
 */
void CatchInterrupts();

/** Has signals to these ranks count, too; they must live as long as the program. */
void ListenTo(Ranks& ranks);

/** Whether there was such a signal. */
bool WasInterrupted();

/**
 * Update the filter, showing its progress; with ranks by all of them together.
 * @throws Failure with the errors that it reports, on this rank.
 */
FilterRun RunFilter(
  vtkAlgorithm* filter, const std::string& title, ProgressStyle style, Ranks* ranks = nullptr);

// ---- Full disks ---------------------------------------------------------------------------------

/**
 * From now on a file in memory whose bytes cannot be read or written any more ends the program with
 * a message and not by a bus error. With a limit of memory arrays are such files. Their room on the
 * disk is taken beforehand, but some file systems, of networks or such that compress, only say so.
 * @param directory where the files are: the option --scratch; may be empty
 */
void TellOfFullDisk(const std::string& directory);
}

#endif
