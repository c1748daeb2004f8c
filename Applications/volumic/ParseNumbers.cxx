// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ParseNumbers.h"

#include "ToolErrors.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace tool
{
template <class T>
T ParseNumber(const std::string& text)
{
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+')
  {
    ++first;
  }
  T value{};
  const auto result = std::from_chars(first, last, value);
  if (first == last || result.ptr != last || result.ec != std::errc{} ||
    !std::isfinite(static_cast<double>(value)))
  {
    throw UsageError(
      "'" + text + "' is not a" + (std::is_same<T, int>::value ? " whole number" : " number"));
  }
  return value;
}

template int ParseNumber<int>(const std::string& text);
template double ParseNumber<double>(const std::string& text);

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
}
