// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThrowInvalidArgument_h
#define volumicThrowInvalidArgument_h

#include "Core/Common/Join.h"

#include <stdexcept>

namespace volumic
{
/** Invalid input or option. Other exceptions are errors of the program. */
class InvalidArgument : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/** Throw InvalidArgument. The parts form the message: what is wrong, and how to fix it. */
template <typename... Parts>
[[noreturn]] void ThrowInvalidArgument(const Parts&... parts)
{
  throw InvalidArgument(Join(parts...));
}
}

#endif
