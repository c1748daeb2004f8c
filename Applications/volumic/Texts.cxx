// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Texts.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

namespace tool
{
std::string Shortened(const std::string& text, std::size_t most)
{
  if (text.size() <= most)
  {
    return text;
  }
  const auto isWithin = [&text](std::size_t at)
  { return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80; };
  std::size_t end = most / 2;
  std::size_t begin = text.size() - most / 2;
  for (; end > 0 && isWithin(end); --end)
  {
  }
  for (; isWithin(begin); ++begin)
  {
  }
  return text.substr(0, end) + " ... " + text.substr(begin);
}

std::string Lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string Trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string SuffixOf(const std::string& name)
{
  return Lower(std::filesystem::path(name).extension().string());
}

std::size_t CharacterBytes(const std::string& text, std::size_t at)
{
  const auto byte = [&](std::size_t i)
  { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u; };
  const unsigned int first = byte(0);
  const std::size_t count = first < 0x80 ? 1
    : first >= 0xC2 && first < 0xE0      ? 2
    : first >= 0xE0 && first < 0xF0      ? 3
    : first >= 0xF0 && first < 0xF5      ? 4
                                         : 0;
  for (std::size_t i = 1; i < count; ++i)
  {
    if ((byte(i) & 0xC0) != 0x80)
    {
      return 0;
    }
  }
  // Long forms, halves of pairs, and what lies behind the last character.
  const bool isRefused = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
    (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
  return isRefused ? 0 : count;
}

std::string AsUtf8(const std::string& text)
{
  std::size_t at = 0;
  while (at < text.size() && CharacterBytes(text, at) > 0)
  {
    at += CharacterBytes(text, at);
  }
  if (at >= text.size())
  {
    return text;
  }
  std::string characters;
  for (const char byte : text)
  {
    const auto code = static_cast<unsigned char>(byte);
    characters += code < 0x80 ? std::string(1, byte)
                              : std::string{ static_cast<char>(0xC0 | code >> 6),
                                  static_cast<char>(0x80 | (code & 0x3F)) };
  }
  return characters;
}

namespace
{
/** As much of a text as has at most so many bytes, in whole characters. */
std::string BeginOf(const std::string& text, std::size_t most)
{
  std::size_t end = 0;
  while (end < text.size() && end + std::max<std::size_t>(CharacterBytes(text, end), 1) <= most)
  {
    end += std::max<std::size_t>(CharacterBytes(text, end), 1);
  }
  return text.substr(0, end);
}
}

std::string SafeName(const std::string& name)
{
  std::string safe;
  for (const char c : name)
  {
    const bool isPlain = static_cast<unsigned char>(c) > 0x20 && c != 0x7F &&
      std::string("/\\:*?\"<>|'`$&;!%").find(c) == std::string::npos;
    safe += isPlain ? c : '_';
  }
  safe.erase(0, std::min(safe.find_first_not_of("._-~ "), safe.size()));
  safe.erase(safe.find_last_not_of("._ ") + 1);
  static const std::set<std::string> devices = { "con", "prn", "aux", "nul", "com1", "com2", "com3",
    "com4", "lpt1", "lpt2", "lpt3" };
  return BeginOf(safe, 120) + (devices.count(Lower(safe)) > 0 ? "_" : "");
}
}
