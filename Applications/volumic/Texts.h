// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTexts_h
#define volumicTexts_h

#include <string>

namespace tool
{
/** ASCII letters made small. */
std::string Lower(std::string text);

/** Without the blanks and line ends at both ends. */
std::string Trimmed(const std::string& text);

bool EndsWith(const std::string& text, const std::string& end);

/** What begins with the last dot of a file's name, in small letters; empty if there is none. */
std::string SuffixOf(const std::string& name);
}

#endif
