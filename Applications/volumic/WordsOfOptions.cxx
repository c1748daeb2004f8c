// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceProperties.h"

#include <array>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

namespace tool
{
namespace
{
struct Phrase
{
  std::string Label;
  std::string InOptions;
};

/** What ParaView's panel calls it: `Iso Value`, and `NaN Is Background`. */
std::string LabelOf(const std::string& property)
{
  std::string label;
  for (std::size_t i = 0; i < property.size(); ++i)
  {
    const bool begins =
      i > 0 && std::isupper(property[i]) != 0 && std::islower(property[i + 1]) != 0;
    label += (begins ? " " : "") + property.substr(i, 1);
  }
  return label;
}

/** What a switch is called may be the contrary: then its property alone is not put in its words. */
void AddSwitch(const PropertyOption& option, std::vector<Phrase>& phrases)
{
  const std::string label = LabelOf(option.Property);
  const std::string name = "--" + option.Option;
  const std::string with = option.Given ? "on" : "off";
  const std::string without = option.Given ? "off" : "on";
  phrases.push_back(
    { label + " was " + without + " and is " + with, name + " was not given and is" });
  phrases.push_back(
    { label + " was " + with + " and is " + without, name + " was given and is not" });
  phrases.push_back({ label + " is " + with, name + " is given" });
  phrases.push_back({ label + " is " + without, name + " is not given" });
  for (const auto& [change, leave, give] :
    { std::array{ "switch ", "leave ", "give " }, std::array{ "Switch ", "Leave ", "Give " } })
  {
    phrases.push_back({ change + label + " " + without, leave + name + " away" });
    phrases.push_back({ change + label + " " + with, give + name });
  }
  if (option.Given)
  {
    phrases.push_back({ label, name });
  }
}

std::vector<Phrase> MakePhrases()
{
  std::vector<Phrase> phrases = { { "Initial Surface (input port 1)", "--initial-surface" },
    { "Attracting Points (input port 2)", "--attracting-points" }, { "Edge Map", "--edges" },
    { "Input port 0", "the volume" }, { "Seed Positions", "--seed-position" },
    { "Attracting Positions", "--attracting-position" } };
  for (const PropertyOption& option : SurfaceProperties())
  {
    if (option.Argument.empty())
    {
      AddSwitch(option, phrases);
    }
    else
    {
      phrases.push_back({ LabelOf(option.Property), "--" + option.Option });
    }
  }
  return phrases;
}

/** Neither within a word nor within the name of a file. */
bool IsAlone(const std::string& message, std::size_t begin, std::size_t end)
{
  const bool isAfterGap = begin == 0 || message[begin - 1] == ' ' || message[begin - 1] == '(';
  const bool isSentenceEnd = end + 1 >= message.size() || message[end + 1] == ' ';
  return isAfterGap &&
    (end == message.size() || message[end] == ' ' || message[end] == ')' ||
      (isSentenceEnd && std::string(".,;:").find(message[end]) != std::string::npos));
}
}

std::string InWordsOfOptions(const std::string& message)
{
  static const std::vector<Phrase> phrases = MakePhrases();
  std::string told;
  for (std::size_t at = 0; at < message.size();)
  {
    const Phrase* longest = nullptr;
    for (const Phrase& phrase : phrases)
    {
      const std::size_t size = phrase.Label.size();
      if ((!longest || size > longest->Label.size()) &&
        message.compare(at, size, phrase.Label) == 0 && IsAlone(message, at, at + size))
      {
        longest = &phrase;
      }
    }
    told += longest ? longest->InOptions : message.substr(at, 1);
    at += longest ? longest->Label.size() : 1;
  }
  return told;
}
}
