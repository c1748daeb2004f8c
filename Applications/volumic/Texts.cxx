// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Texts.h"

#include "Json.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <system_error>

namespace tool
{
namespace
{
/** Whether a place of a text is within a character of UTF-8. */
bool IsWithin(const std::string& text, std::size_t at)
{
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

/** As much of a text as has at most so many bytes, in whole characters. */
std::string BeginOf(const std::string& text, std::size_t most)
{
  std::size_t end = most;
  for (; end > 0 && IsWithin(text, end); --end)
  {
  }
  return text.substr(0, end);
}
}

std::string Shortened(const std::string& text, std::size_t most)
{
  if (text.size() <= most)
  {
    return text;
  }
  std::size_t begin = text.size() - most / 2;
  for (; IsWithin(text, begin); ++begin)
  {
  }
  return BeginOf(text, most / 2) + " ... " + text.substr(begin);
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

std::vector<std::string> SplitAtCommas(const std::string& text)
{
  std::vector<std::string> parts;
  std::size_t start = 0;
  while (start <= text.size())
  {
    const std::size_t end = std::min(text.find(',', start), text.size());
    parts.push_back(Trimmed(text.substr(start, end - start)));
    start = end + 1;
  }
  return parts;
}

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string SuffixOf(const std::string& name)
{
  return Lower(std::filesystem::path(name).extension().string());
}

std::string AsUtf8(const std::string& text)
{
  try
  {
    Json(text).dump(); // looks whether it is UTF-8 (RFC 3629)
    return text;
  }
  catch (const Json::type_error&)
  {
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
}

std::string DistinctNames::Take(const std::string& name)
{
  std::string free = name;
  for (int more = 2; !this->Taken.insert(Lower(free)).second; ++more)
  {
    free = name + this->Separator + std::to_string(more);
  }
  return free;
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

// ---- Numbers ------------------------------------------------------------------------------------

template <class T>
std::optional<T> AsNumber(const std::string& text)
{
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+')
  {
    ++first;
  }
  T value{};
  const auto result = std::from_chars(first, last, value);
  const bool isOne = first != last && result.ptr == last && result.ec == std::errc{} &&
    std::isfinite(static_cast<double>(value));
  return isOne ? std::optional<T>(value) : std::nullopt;
}

template std::optional<int> AsNumber<int>(const std::string& text);
template std::optional<double> AsNumber<double>(const std::string& text);

template <class T>
T ParseNumber(const std::string& text)
{
  const std::optional<T> value = AsNumber<T>(text);
  if (!value)
  {
    throw UsageError(
      "'" + text + "' is not a" + (std::is_same<T, int>::value ? " whole number" : " number"));
  }
  return *value;
}

template int ParseNumber<int>(const std::string& text);
template double ParseNumber<double>(const std::string& text);

int ParseMebibytes(const std::string& text)
{
  const std::string lower = Lower(text);
  const std::size_t end = std::min(lower.find_first_of("kmgtbi"), lower.size());
  const std::string unit = lower.substr(end);
  const double number = ParseNumber<double>(lower.substr(0, end));
  static const std::map<std::string, double> units = { { "k", 0x1p-10 }, { "m", 1.0 },
    { "g", 0x1p10 }, { "t", 0x1p20 } };
  const auto found = units.find(unit.substr(0, 1));
  const bool isUnit =
    found != units.end() && (unit.size() == 1 || unit.substr(1) == "b" || unit.substr(1) == "ib");
  FailIf<UsageError>(!isUnit && !(unit.empty() && number == 0.0),
    "'" + text + "' has no unit: give it as 1500M or 2G; 0 is no limit");
  const double mebibytes = isUnit ? std::ceil(number * found->second) : 0.0;
  FailIf<UsageError>(!(mebibytes >= 0.0 && mebibytes <= std::numeric_limits<int>::max()),
    "'" + text + "' is no amount of memory");
  return static_cast<int>(mebibytes);
}

std::vector<double> ParseNumbers(const std::string& text, std::size_t count)
{
  const std::vector<std::string> parts = SplitAtCommas(text);
  std::vector<double> numbers(parts.size());
  std::transform(parts.begin(), parts.end(), numbers.begin(), ParseNumber<double>);
  FailIf<UsageError>(numbers.size() != count,
    "'" + text + "' are " + std::to_string(numbers.size()) + " numbers, not " +
      std::to_string(count));
  return numbers;
}

std::string NumberText(double value)
{
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr);
}

std::string NumberText(int value)
{
  return std::to_string(value);
}

std::string MebibytesText(int mebibytes)
{
  return mebibytes == 0 ? "0" : NumberText(mebibytes) + "M";
}
}
