// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Wavefront's .obj: lines of words. Corners of faces are numbers of points, of texture coordinates
// and of normals, as 1/2/3, 1/2, 1//3 or 1; less than 0 they count from the last one so far.
#include "CheckInputs.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

namespace tool
{
namespace
{
/** How many points, texture coordinates and normals there are. */
using Counts = std::array<long, 3>;

/**
 * @return the signs between the numbers of a corner.
 * @throws Failure unless these are of things that were told of before.
 */
std::string CheckCorner(const std::string& corner, const Counts& counts, int line)
{
  std::istringstream parts(corner);
  std::size_t kind = 0;
  for (std::string part; std::getline(parts, part, '/'); ++kind)
  {
    const bool isLeftOut = part.empty() && kind == 1;
    const long number = isLeftOut ? 1 : AsNumber<int>(part).value_or(0);
    if (kind > 2 || number == 0 || corner.back() == '/' ||
      (!isLeftOut && std::abs(number) > counts[kind]))
    {
      throw Failure("is damaged: line " + std::to_string(line) + " has the corner '" +
        Shortened(corner, 40) + "', which is none of the " + std::to_string(counts[0]) +
        " points before it, or has no such texture or normal");
    }
  }
  return corner.find("//") != std::string::npos ? "//" : std::string(kind - 1, '/');
}
}

void CheckObj(const std::string& name)
{
  constexpr std::size_t longest = 1000; // VTK's reader has room for 1024 bytes
  static const std::map<std::string, std::size_t> kinds = { { "v", 0 }, { "vt", 1 }, { "vn", 2 } };
  std::ifstream file(name, std::ios::binary);
  Counts counts = { 0, 0, 0 };
  std::string text;
  std::string whole;
  for (int line = 1; std::getline(file, text); ++line)
  {
    if (text.size() > longest || text.find('\0') != std::string::npos)
    {
      throw Failure("is damaged: line " + std::to_string(line) + " is too long, or no text");
    }
    whole += Trimmed(text);
    if (!whole.empty() && whole.back() == '\\') // goes on in the next one
    {
      whole.back() = ' ';
      continue;
    }
    std::istringstream words(whole);
    whole.clear();
    std::string word;
    words >> word;
    const auto kind = kinds.find(word);
    if (kind != kinds.end())
    {
      ++counts[kind->second];
    }
    else if (word == "f" || word == "l" || word == "p")
    {
      std::set<std::string> forms;
      while (words >> word)
      {
        forms.insert(CheckCorner(word, counts, line));
      }
      if (forms.size() != 1)
      {
        throw Failure("is damaged: line " + std::to_string(line) + " has corners of " +
          std::to_string(forms.size()) + " kinds");
      }
    }
  }
}
}
