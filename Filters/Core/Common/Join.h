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
/**
 * Six digits, as a stream's, but all of those of large values, which may differ in the last ones.
 */
template <typename Part>
void WritePart(std::ostream& text, const Part& part)
{
  if constexpr (std::is_floating_point_v<Part>)
  {
    constexpr int fewDigits = 6;
    constexpr int allDigits = 15; // Of any number, digits10 of a double.
    const double size = std::abs(static_cast<double>(part));
    text.precision(size >= 1e6 && size < 1e15 ? allDigits : fewDigits);
  }
  text << part;
}

/**
 * The parts as one text, numbers as everyone reads them: `1000` and `0.5`, also in a program whose
 * global locale would write `1.000` and `0,5`.
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
