// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicParseNumbers_h
#define volumicParseNumbers_h

#include <string>
#include <vector>

namespace tool
{
/**
 * The number that is the whole text, whatever the locale. T is int or double.
 * @throws UsageError if the text is not a finite number of this type.
 */
template <class T>
T ParseNumber(const std::string& text);

/** Numbers separated by commas. @throws UsageError as ParseNumber does, or for another count. */
std::vector<double> ParseNumbers(const std::string& text, std::size_t count);

/** The shortest text that ParseNumber takes back to the same number; "nan" and "inf" as such. */
std::string NumberText(double value);
std::string NumberText(int value);
}

#endif
