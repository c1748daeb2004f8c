// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ContentHash.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace volumic
{
namespace
{
/** Bytes that have a hash of their own. */
constexpr std::size_t SpanSize = 1 << 20;
/** Words that are worked on side by side: a product waits for the one before it. */
constexpr std::size_t Strands = 4;

/** Two bijections of 64 bits; the numbers are those of MurmurHash3's finalizer (A. Appleby). */
std::uint64_t Mix(std::uint64_t x)
{
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
  return x ^ x >> 33;
}

/** Goes on with a hash by another word. */
std::uint64_t AddWord(std::uint64_t hash, std::uint64_t word)
{
  hash = (hash ^ word) * 0xff51afd7ed558ccdu; // See Mix().
  return hash ^ hash >> 32;
}

std::uint64_t HashOfSpan(const unsigned char* bytes, std::size_t count)
{
  std::array<std::uint64_t, Strands> hash = { 1, 2, 3, 4 };
  std::array<std::uint64_t, Strands> words;
  std::size_t done = 0;
  for (; done + sizeof(words) <= count; done += sizeof(words))
  {
    std::memcpy(words.data(), bytes + done, sizeof(words));
    for (std::size_t k = 0; k < Strands; ++k)
    {
      hash[k] = AddWord(hash[k], words[k]);
    }
  }
  words = {};
  if (done < count)
  {
    std::memcpy(words.data(), bytes + done, count - done);
  }
  std::uint64_t all = count; // The zeros at the end are none of its own.
  for (std::size_t k = 0; k < Strands; ++k)
  {
    all = CombineHashes(all, AddWord(hash[k], words[k]));
  }
  return all;
}
}

std::uint64_t CombineHashes(std::uint64_t first, std::uint64_t second)
{
  return Mix(Mix(first) + second);
}

std::uint64_t ContentHash(const void* bytes, std::size_t count)
{
  const auto* first = static_cast<const unsigned char*>(bytes);
  std::uint64_t all = 0;
  for (std::size_t begin = 0; begin < count; begin += SpanSize)
  {
    all = CombineHashes(all, HashOfSpan(first + begin, std::min(SpanSize, count - begin)));
  }
  return all;
}

std::string HashText(std::uint64_t hash)
{
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit)
  {
    *digit = "0123456789abcdef"[hash & 15u];
    hash >>= 4;
  }
  return text;
}
}
