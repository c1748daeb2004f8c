// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumic_Refuse_h
#define volumic_Refuse_h

#include <sstream>
#include <stdexcept>
#include <string>

namespace volumic
{
/// The parts as one text, as a stream would write them.
template <typename... Parts>
std::string Join(const Parts&... parts)
{
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Throws std::invalid_argument with the parts as its message: what is wrong, and the way out.
template <typename... Parts>
[[noreturn]] void Refuse(const Parts&... parts)
{
  throw std::invalid_argument(Join(parts...));
}
}

#endif
