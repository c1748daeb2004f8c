// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "JsonReader.h"

#include "ParseNumbers.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>

namespace tool
{
namespace
{
class Parser
{
public:
  explicit Parser(const std::string& text) : All(text) {}

  JsonValue Document()
  {
    JsonValue value = this->Value(0);
    this->SkipBlanks();
    if (this->At < this->All.size())
    {
      this->Refuse("something follows the end");
    }
    return value;
  }

private:
  [[noreturn]] void Refuse(const std::string& reason) const
  {
    const auto end =
      this->All.begin() + static_cast<std::ptrdiff_t>(std::min(this->At, this->All.size()));
    throw Failure("line " + std::to_string(1 + std::count(this->All.begin(), end, '\n')) +
      " is not as JSON has it: " + reason);
  }

  /** The next character; 0 behind the last. */
  char Next() const { return this->At < this->All.size() ? this->All[this->At] : '\0'; }

  void SkipBlanks()
  {
    this->At = std::min(this->All.find_first_not_of(" \t\r\n", this->At), this->All.size());
  }

  /** Whether the next thing is this sign, which is passed over then. */
  bool Takes(char sign)
  {
    this->SkipBlanks();
    const bool isNext = this->Next() == sign && this->At < this->All.size();
    this->At += isNext ? 1 : 0;
    return isNext;
  }

  void Need(char sign)
  {
    if (!this->Takes(sign))
    {
      this->Refuse(
        this->At < this->All.size() ? std::string("no '") + sign + "'" : "it is cut off");
    }
  }

  JsonValue Value(int depth);
  JsonValue Object(int depth);
  JsonValue Array(int depth);
  JsonValue Word();
  std::string Text();
  void Escape(std::string& text);
  unsigned int FourDigits();

  const std::string& All;
  std::size_t At = 0;
};

JsonValue Parser::Value(int depth)
{
  if (depth > 64)
  {
    this->Refuse("it is nested too deeply");
  }
  this->SkipBlanks();
  JsonValue value;
  switch (this->Next())
  {
    case '{':
      return this->Object(depth);
    case '[':
      return this->Array(depth);
    case '"':
      value.Form = JsonValue::Kind::Text;
      value.Text = this->Text();
      return value;
    default:
      return this->Word();
  }
}

JsonValue Parser::Object(int depth)
{
  JsonValue value;
  value.Form = JsonValue::Kind::Object;
  this->Need('{');
  if (this->Takes('}'))
  {
    return value;
  }
  do
  {
    this->SkipBlanks();
    if (this->Next() != '"')
    {
      this->Refuse(this->At < this->All.size() ? "no name in quotes" : "it is cut off");
    }
    std::string name = this->Text();
    this->Need(':');
    value.Members.emplace_back(std::move(name), this->Value(depth + 1));
  } while (this->Takes(','));
  this->Need('}');
  return value;
}

JsonValue Parser::Array(int depth)
{
  JsonValue value;
  value.Form = JsonValue::Kind::Array;
  this->Need('[');
  if (this->Takes(']'))
  {
    return value;
  }
  do
  {
    value.Items.push_back(this->Value(depth + 1));
  } while (this->Takes(','));
  this->Need(']');
  return value;
}

/** A number, or one of the three names of values. */
JsonValue Parser::Word()
{
  const std::size_t end =
    std::min(this->All.find_first_of(" \t\r\n,:]}[{\"", this->At), this->All.size());
  const std::string word = this->All.substr(this->At, end - this->At);
  JsonValue value;
  if (word == "true" || word == "false")
  {
    value.Form = JsonValue::Kind::Boolean;
  }
  else if (word != "null")
  {
    const std::optional<double> number = AsNumber<double>(word);
    if (!number)
    {
      this->Refuse(word.empty() ? "a value is missing" : "'" + word.substr(0, 40) + "'");
    }
    value.Form = JsonValue::Kind::Number;
    value.Number = *number;
  }
  this->At = end;
  return value;
}

std::string Parser::Text()
{
  std::string text;
  ++this->At; // the quote
  while (this->At < this->All.size() && this->Next() != '"')
  {
    if (this->Next() == '\\')
    {
      this->Escape(text);
    }
    else
    {
      text += this->All[this->At++];
    }
  }
  if (this->At++ >= this->All.size())
  {
    this->At = this->All.size();
    this->Refuse("a text does not end");
  }
  return text;
}

unsigned int Parser::FourDigits()
{
  const std::string digits = this->All.substr(std::min(this->At, this->All.size()), 4);
  if (digits.size() < 4 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
  {
    this->Refuse("\\u without four digits");
  }
  this->At += 4;
  return static_cast<unsigned int>(std::strtoul(digits.c_str(), nullptr, 16));
}

/** What a backslash begins. */
void Parser::Escape(std::string& text)
{
  static const std::string letters = "\"\\/bfnrt";
  static const std::string meanings = "\"\\/\b\f\n\r\t";
  ++this->At;
  const char letter = this->Next();
  ++this->At;
  const std::size_t which = letters.find(letter);
  if (which != std::string::npos)
  {
    text += meanings[which];
    return;
  }
  if (letter != 'u')
  {
    this->Refuse("an unknown letter after a backslash");
  }
  unsigned int code = this->FourDigits();
  if (code >= 0xD800 && code < 0xDC00 && this->All.compare(this->At, 2, "\\u") == 0)
  {
    this->At += 2;
    code = 0x10000 + ((code - 0xD800) << 10) + ((this->FourDigits() - 0xDC00) & 0x3FF);
  }
  text += Utf8Character(code);
}
}

const JsonValue* JsonValue::Find(const std::string& name) const
{
  for (const auto& [each, value] : this->Members)
  {
    if (Lower(each) == Lower(name))
    {
      return &value;
    }
  }
  return nullptr;
}

JsonValue ParseJson(const std::string& text)
{
  return Parser(text).Document();
}
}
