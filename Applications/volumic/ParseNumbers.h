// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicParseNumbers_h
#define volumicParseNumbers_h

#include <optional>
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

/** The same; nothing instead of an exception, for files that have thousands of other words. */
template <class T>
std::optional<T> AsNumber(const std::string& text);

/**
 * The MiB that a text such as 2G, 1500M or 1.5GiB stands for, rounded up: K, M, G and T are powers
 * of 1024. "0" is 0, other numbers must have a unit. @throws UsageError for other texts.
 */
int ParseMebibytes(const std::string& text);

/** Numbers separated by commas. @throws UsageError as ParseNumber does, or for another count. */
std::vector<double> ParseNumbers(const std::string& text, std::size_t count);

/** The shortest text that ParseNumber takes back to the same number; "nan" and "inf" as such. */
std::string NumberText(double value);
std::string NumberText(int value);

/** The text for ParseMebibytes: 0, or as 1500M. */
std::string MebibytesText(int mebibytes);
}

#endif
