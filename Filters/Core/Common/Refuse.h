// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRefuse_h
#define volumicRefuse_h

#include "Core/Common/Join.h"

#include <stdexcept>

namespace volumic
{
/** Throws std::invalid_argument with the parts as its message: what is wrong, and the way out. */
template <typename... Parts>
[[noreturn]] void Refuse(const Parts&... parts)
{
  throw std::invalid_argument(Join(parts...));
}
}

#endif
