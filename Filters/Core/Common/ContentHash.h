// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicContentHash_h
#define volumicContentHash_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace volumic
{
/**
 * 64 bits that tell contents apart: not against forgery, but against what is another by chance or
 * by damage. Another one where the processor's order of bytes is.
 */
std::uint64_t ContentHash(const void* bytes, std::size_t count);

/** Goes on with a hash by another word. */
inline std::uint64_t AddWord(std::uint64_t hash, std::uint64_t word)
{
  hash = (hash ^ word) * 0xff51afd7ed558ccdu; // See Mix() in ContentHash.cxx.
  return hash ^ hash >> 32;
}

/** The same by a value without padding: a hash of few bytes, which is faster so. */
template <typename T>
std::uint64_t AddValue(std::uint64_t hash, const T& value)
{
  static_assert(std::is_trivially_copyable<T>::value, "its bytes are its value");
  std::array<std::uint64_t, (sizeof(T) + 7) / 8> words{};
  std::memcpy(words.data(), &value, sizeof(T));
  for (const std::uint64_t word : words)
  {
    hash = AddWord(hash, word);
  }
  return hash;
}

/** The hash of two contents, one after the other, of their hashes. */
std::uint64_t CombineHashes(std::uint64_t first, std::uint64_t second);

/** A hash as 16 hexadecimal digits. */
std::string HashText(std::uint64_t hash);
}

#endif
