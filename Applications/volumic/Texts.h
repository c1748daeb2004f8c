// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTexts_h
#define volumicTexts_h

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tool
{
/** The text, or of a longer one about so many bytes at its begin and its end, in whole characters.
 */
std::string Shortened(const std::string& text, std::size_t most);

/** ASCII letters made small. */
std::string Lower(std::string text);

/** Without the blanks and line ends at both ends. */
std::string Trimmed(const std::string& text);

/** What is between commas, without blanks about it. */
std::vector<std::string> SplitAtCommas(const std::string& text);

bool EndsWith(const std::string& text, const std::string& end);

/** What begins with the last dot of a file's name, in small letters; empty if there is none. */
std::string SuffixOf(const std::string& name);

/** The text in UTF-8: as it is, or, where it is none, from Latin-1, whose bytes are characters. */
std::string AsUtf8(const std::string& text);

/** Of a name what may be that of a file, on the systems of others, too; may be empty. */
std::string SafeName(const std::string& name);

/** Names of which no two are the same, in small letters, too. */
class DistinctNames
{
public:
  explicit DistinctNames(const std::string& separator) : Separator(separator) {}

  /** @return the name, or, where it is taken, with a separator and a number behind it */
  std::string Take(const std::string& name);

private:
  std::string Separator;
  std::set<std::string> Taken;
};

// ---- Numbers ------------------------------------------------------------------------------------

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
