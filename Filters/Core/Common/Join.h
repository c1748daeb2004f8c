// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJoin_h
#define volumicJoin_h

#include <cmath>
#include <locale>
#include <sstream>
#include <string>
#include <type_traits>

namespace volumic
{
/** Write six digits, or all digits of large values, which may differ in the last ones. */
template <typename Part>
void WritePart(std::ostream& text, const Part& part)
{
  if constexpr (std::is_floating_point_v<Part>)
  {
    constexpr int fewDigits = 6;
    constexpr int allDigits = 15; // std::numeric_limits<double>::digits10
    const double size = std::abs(static_cast<double>(part));
    text.precision(size >= 1e6 && size < 1e15 ? allDigits : fewDigits);
  }
  text << part;
}

/**
 * Concatenate the parts to one text. Numbers have the C locale (`1000`, `0.5`), whatever the global
 * locale is.
 */
template <typename... Parts>
std::string Join(const Parts&... parts)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  (WritePart(text, parts), ...);
  return text.str();
}
}

#endif
