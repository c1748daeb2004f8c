// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPrefixErrors_h
#define volumicPrefixErrors_h

#include "Core/Common/Refuse.h"

#include <stdexcept>
#include <string>

namespace volumic
{
/**
 * What the work gives; what it refuses (Refuse.h) is refused with the place in front, so that the
 * message names it: `Input port 0: `.
 * @throws std::invalid_argument as the work does; other exceptions pass as they are.
 */
template <typename Work>
auto PrefixErrors(const std::string& place, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const std::invalid_argument& error)
  {
    Refuse(place, error.what());
  }
}
}

#endif
