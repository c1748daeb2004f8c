// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTexts_h
#define volumicTexts_h

#include <cstddef>
#include <string>

namespace tool
{
/** The text, or of a longer one about so many bytes at its begin and its end, in whole characters. */
std::string Shortened(const std::string& text, std::size_t most);

/** ASCII letters made small. */
std::string Lower(std::string text);

/** Without the blanks and line ends at both ends. */
std::string Trimmed(const std::string& text);

bool EndsWith(const std::string& text, const std::string& end);

/** What begins with the last dot of a file's name, in small letters; empty if there is none. */
std::string SuffixOf(const std::string& name);

/** Bytes of the UTF-8 character that begins at a place of the text; 0 if none does (RFC 3629). */
std::size_t CharacterBytes(const std::string& text, std::size_t at);

/** The text in UTF-8: as it is, or, where it is none, from Latin-1, whose bytes are characters. */
std::string AsUtf8(const std::string& text);

/** Of a name what may be that of a file, on the systems of others, too; may be empty. */
std::string SafeName(const std::string& name);
}

#endif
