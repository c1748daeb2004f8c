// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRefuse_h
#define volumicRefuse_h

#include "Core/Common/Join.h"

#include <stdexcept>

namespace volumic
{
/** An input or an option that cannot be used. Other exceptions are errors of the program. */
class Refusal : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/** Throws a Refusal with the parts as its message: what is wrong, and the way out. */
template <typename... Parts>
[[noreturn]] void Refuse(const Parts&... parts)
{
  throw Refusal(Join(parts...));
}
}

#endif
