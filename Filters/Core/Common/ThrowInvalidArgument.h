// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThrowInvalidArgument_h
#define volumicThrowInvalidArgument_h

#include "Core/Common/Join.h"

#include <stdexcept>

namespace volumic
{
/** An input or an option that cannot be used. Other exceptions are errors of the program. */
class InvalidArgument : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/** Throws a Refusal with the parts as its message: what is wrong, and the way out. */
template <typename... Parts>
[[noreturn]] void ThrowInvalidArgument(const Parts&... parts)
{
  throw InvalidArgument(Join(parts...));
}
}

#endif
