// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "RunFigures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <istream>
#include <limits>
#include <ostream>
#include <stdexcept>

namespace volumic
{
namespace bench
{
namespace
{

const std::string NumberMark = "@number ";
const std::string TextMark = "@text ";

bool TakeMark(std::string& line, const std::string& mark)
{
  if (line.compare(0, mark.size(), mark) != 0)
  {
    return false;
  }
  line.erase(0, mark.size());
  return true;
}

std::string Formatted(const char* format, int digits, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, digits, value);
  return text;
}

std::string CsvField(const std::string& text)
{
  if (text.find_first_of(",\"\n") == std::string::npos)
  {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text)
  {
    quoted += c;
    if (c == '"')
    {
      quoted += c;
    }
  }
  return quoted + "\"";
}

} // namespace

double RunFigures::Get(const std::string& name) const
{
  const auto found = this->Numbers.find(name);
  return found == this->Numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string RunFigures::GetText(const std::string& name) const
{
  const auto found = this->Texts.find(name);
  return found == this->Texts.end() ? std::string() : found->second;
}

void RunFigures::Write(std::ostream& stream) const
{
  for (const auto& [name, value] : this->Numbers)
  {
    stream << NumberMark << name << ' ' << Formatted("%.*g", 17, value) << '\n';
  }
  for (const auto& [name, text] : this->Texts)
  {
    stream << TextMark << name << ' ' << text << '\n';
  }
  stream.flush();
}

void RunFigures::Read(std::istream& stream)
{
  for (std::string line; std::getline(stream, line);)
  {
    const bool isNumber = TakeMark(line, NumberMark);
    if (!isNumber && !TakeMark(line, TextMark))
    {
      continue;
    }
    const std::size_t blank = line.find(' ');
    const std::string name = line.substr(0, blank);
    const std::string value = blank == std::string::npos ? "" : line.substr(blank + 1);
    if (isNumber)
    {
      this->Set(name, std::stod(value)); // takes nan and inf too
    }
    else
    {
      this->SetText(name, value);
    }
  }
}

//------------------------------------------------------------------------------
void WriteCsv(const std::string& file, const std::vector<std::vector<std::string>>& rows)
{
  std::ofstream stream(file);
  for (const std::vector<std::string>& row : rows)
  {
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      stream << (i == 0 ? "" : ",") << CsvField(row[i]);
    }
    stream << '\n';
  }
  stream.close();
  if (!stream)
  {
    throw std::runtime_error(file + ": can't be written");
  }
}

std::string CsvNameOf(const std::string& file, const std::string& what)
{
  const std::string ending = ".csv";
  const bool hasEnding = file.size() > ending.size() &&
    file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
  return file.substr(0, file.size() - (hasEnding ? ending.size() : 0)) + "-" + what + ending;
}

std::string ExactText(double value)
{
  return std::isnan(value) ? "" : Formatted("%.*g", 10, value);
}

std::string ShortText(double value, int digits)
{
  if (std::isnan(value))
  {
    return "-";
  }
  if (!std::isfinite(value))
  {
    return value > 0.0 ? "inf" : "-inf";
  }
  if (value == 0.0)
  {
    return "0";
  }
  const int magnitude = static_cast<int>(std::floor(std::log10(std::fabs(value)))) + 1;
  if (value == std::rint(value) && std::fabs(value) < 1e15)
  {
    return Formatted("%.*f", 0, value); // a number of things: all of it
  }
  if (magnitude < -3)
  {
    return Formatted("%.*g", digits, value);
  }
  return Formatted("%.*f", std::max(0, digits - magnitude), value);
}

} // namespace bench
} // namespace volumic
