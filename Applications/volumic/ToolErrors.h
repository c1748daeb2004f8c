// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolErrors_h
#define volumicToolErrors_h

#include <stdexcept>

namespace tool
{
/** Exit codes of the program; the manual page lists them. */
enum ExitCode
{
  Success = 0,
  RuntimeFailure = 1, ///< a file, the image or the filter; nothing or not everything was written
  UsageFailure = 2,   ///< the command line
  Unfinished = 3 ///< interrupted, at the time or the iteration limit; what there was is written
};

/** A file that cannot be read or written, or a volume without a surface. */
struct Failure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/** A command line that makes no sense. */
struct UsageError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};
}

#endif
