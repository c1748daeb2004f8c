// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "JsonWriter.h"

#include "ParseNumbers.h"
#include "Texts.h"

#include <cmath>
#include <cstdio>

namespace tool
{
namespace
{
/** Names of files may be any bytes: those that are not UTF-8 become the replacement character. */
std::string ValidText(const std::string& text)
{
  std::string valid;
  for (std::size_t at = 0; at < text.size();)
  {
    const std::size_t count = CharacterBytes(text, at);
    valid += count > 0 ? text.substr(at, count) : "\xEF\xBF\xBD";
    at += count > 0 ? count : 1;
  }
  return valid;
}

std::string Quoted(const std::string& text)
{
  std::string quoted = "\"";
  for (const char c : ValidText(text))
  {
    if (c == '"' || c == '\\')
    {
      quoted += '\\';
      quoted += c;
    }
    else if (static_cast<unsigned char>(c) < 0x20)
    {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned int>(c));
      quoted += escape;
    }
    else
    {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string JsonNumber(double value)
{
  if (!std::isfinite(value))
  {
    return "null";
  }
  const bool isWhole = value == std::floor(value) && std::abs(value) < 1e15;
  return isWhole ? std::to_string(static_cast<long long>(value)) : NumberText(value);
}
}

void JsonWriter::Separate()
{
  if (this->AfterName)
  {
    this->AfterName = false;
    return;
  }
  if (this->Depth > 0)
  {
    this->Out << (this->IsFirst ? "\n" : ",\n") << std::string(2 * this->Depth, ' ');
  }
  this->IsFirst = false;
}

void JsonWriter::Begin(char bracket)
{
  this->Separate();
  this->Out << bracket;
  ++this->Depth;
  this->IsFirst = true;
}

void JsonWriter::End(char bracket)
{
  --this->Depth;
  if (!this->IsFirst)
  {
    this->Out << "\n" << std::string(2 * this->Depth, ' ');
  }
  this->Out << bracket << (this->Depth == 0 ? "\n" : "");
  this->IsFirst = false;
}

void JsonWriter::Name(const std::string& name)
{
  this->Separate();
  this->Out << Quoted(name) << ": ";
  this->AfterName = true;
}

void JsonWriter::Value(const std::string& text)
{
  this->Separate();
  this->Out << Quoted(text);
}

void JsonWriter::Value(bool value)
{
  this->Separate();
  this->Out << (value ? "true" : "false");
}

void JsonWriter::Value(double value)
{
  this->Separate();
  this->Out << JsonNumber(value);
}

void JsonWriter::Numbers(const std::string& name, const double* values, int count)
{
  this->Name(name);
  this->Separate();
  this->Out << "[";
  for (int i = 0; i < count; ++i)
  {
    this->Out << (i ? ", " : "") << JsonNumber(values[i]);
  }
  this->Out << "]";
}
}
