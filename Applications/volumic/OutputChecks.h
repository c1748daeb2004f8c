// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicOutputChecks_h
#define volumicOutputChecks_h

#include <string>
#include <vector>

namespace tool
{
/** What is to be written, as the command line names it. */
struct OutputName
{
  enum class Kind
  {
    File,
    Blocks, ///< a .vtm or .pvtp, and the files STEM/STEM_... beside it
    Folder, ///< the files Prefix-....vtp in it; it may have to be made
    Place   ///< a folder likewise, of files that are not known yet
  };
  std::string Name;
  Kind Form = Kind::File;
  std::string Prefix; ///< of a Folder
};

/**
 * Find out before the work begins whether the outputs can be written: their folders are there and
 * let files be made in them, no file is a folder or write-protected, and none is one of the inputs
 * or another output, by whatever name or link.
 * @throws Failure that names the output.
 */
void CheckOutputs(const std::vector<OutputName>& outputs, const std::vector<std::string>& inputs);
}

#endif
