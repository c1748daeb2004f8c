// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "JsonWriter.h"

#include "ParseNumbers.h"

#include <cmath>
#include <cstdio>

namespace tool
{
namespace
{
/** Bytes of the UTF-8 character that begins here; 0 if none does (RFC 3629). */
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
