// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ParseNumbers.h"

#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <system_error>

namespace tool
{
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
  const bool isUnit = found != units.end() &&
    (unit.size() == 1 || unit.substr(1) == "b" || unit.substr(1) == "ib");
  if (!isUnit && !(unit.empty() && number == 0.0))
  {
    throw UsageError("'" + text + "' has no unit: give it as 1500M or 2G; 0 is no limit");
  }
  const double mebibytes = isUnit ? std::ceil(number * found->second) : 0.0;
  if (!(mebibytes >= 0.0 && mebibytes <= std::numeric_limits<int>::max()))
  {
    throw UsageError("'" + text + "' is no amount of memory");
  }
  return static_cast<int>(mebibytes);
}

std::vector<double> ParseNumbers(const std::string& text, std::size_t count)
{
  std::vector<double> numbers;
  std::size_t start = 0;
  while (start <= text.size())
  {
    const std::size_t end = std::min(text.find(',', start), text.size());
    numbers.push_back(ParseNumber<double>(text.substr(start, end - start)));
    start = end + 1;
  }
  if (numbers.size() != count)
  {
    throw UsageError("'" + text + "' are " + std::to_string(numbers.size()) + " numbers, not " +
      std::to_string(count));
  }
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
