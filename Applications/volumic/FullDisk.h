// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFullDisk_h
#define volumicFullDisk_h

#include <string>

namespace tool
{
/**
 * From now on a file in memory whose bytes cannot be read or written any more ends the program with
 * a message and not by a bus error. With a limit of memory arrays are such files. Their room on the
 * disk is taken beforehand, but some file systems, of networks or such that compress, only say so.
 * @param directory where the files are: the option --scratch; may be empty
 */
void TellOfFullDisk(const std::string& directory);
}

#endif
