// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicContentHash_h
#define volumicContentHash_h

#include <cstddef>
#include <cstdint>
#include <string>

namespace volumic
{
/**
 * 64 bits that tell contents apart: not against forgery, but against what is another by chance or
 * by damage. Another one where the processor's order of bytes is.
 */
std::uint64_t ContentHash(const void* bytes, std::size_t count);

/** The hash of two contents, one after the other, of their hashes. */
std::uint64_t CombineHashes(std::uint64_t first, std::uint64_t second);

/** A hash as 16 hexadecimal digits. */
std::string HashText(std::uint64_t hash);
}

#endif
