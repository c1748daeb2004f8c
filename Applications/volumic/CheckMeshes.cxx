// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace tool
{
// ---- .ply ---------------------------------------------------------------------------------------

// A text head tells of elements, and their properties; each property is a number, or a list of
// numbers behind their count.
namespace
{
/** A type of numbers, and the largest of them; 0: of numbers that are not whole. */
struct NumberType
{
  int Bytes = 0;
  std::uint64_t Largest = 0;
};

struct Property
{
  std::string Name;
  NumberType Count; ///< of a list; of 0 bytes: there is one number
  NumberType Value;
};

struct Elements
{
  std::string Name;
  std::uint64_t Count = 0;
  std::vector<Property> Properties;
};

struct Head
{
  std::string Format;
  std::vector<Elements> Parts;
};

NumberType TypeOf(const std::string& type)
{
  static const NumberType int8 = { 1, 0x7F };
  static const NumberType uint8 = { 1, 0xFF };
  static const NumberType int16 = { 2, 0x7FFF };
  static const NumberType uint16 = { 2, 0xFFFF };
  static const NumberType int32 = { 4, 0x7FFFFFFF };
  static const std::map<std::string, NumberType> types = { { "char", int8 }, { "uchar", uint8 },
    { "int8", int8 }, { "uint8", uint8 }, { "short", int16 }, { "ushort", uint16 },
    { "int16", int16 }, { "uint16", uint16 }, { "int", int32 }, { "uint", int32 },
    { "int32", int32 }, { "uint32", int32 }, { "float", { 4, 0 } }, { "float32", { 4, 0 } },
    { "double", { 8, 0 } }, { "float64", { 8, 0 } } };
  return EntryOf(types, type, "its header is damaged: '" + type + "' is no type");
}

/** Read the head; the stream stands behind it. */
Head ReadHead(std::istream& file)
{
  Head head;
  std::string line;
  // VTK's reader has room for 4096 bytes, and takes zeros for the ends of lines.
  constexpr std::size_t longest = 4000;
  while (std::getline(file, line) && line.size() <= longest && line.find('\0') == std::string::npos)
  {
    std::istringstream words(line);
    std::string word;
    std::string type;
    words >> word >> type;
    if (word == "end_header")
    {
      return head;
    }
    if (word == "format")
    {
      head.Format = type;
    }
    else if (word == "element")
    {
      head.Parts.emplace_back();
      head.Parts.back().Name = type;
      FailIf(!(words >> head.Parts.back().Count) ||
          head.Parts.back().Count > std::numeric_limits<int>::max(),
        "its header is damaged: no number of elements '" + type + "'");
    }
    else if (word == "property")
    {
      FailIf(head.Parts.empty(), "its header is damaged: a property of no element");
      Property property;
      if (type == "list")
      {
        words >> word >> type;
        property.Count = TypeOf(word);
      }
      property.Value = TypeOf(type);
      FailIf(!(words >> property.Name), "its header is damaged: a property has no name");
      head.Parts.back().Properties.push_back(property);
    }
    else if (word != "ply" && word != "comment" && word != "obj_info")
    {
      throw Failure("its header is damaged: it has a line '" + Shortened(word, 80) + "'");
    }
  }
  throw Failure("the file is cut off, or no polygon file: its header does not end");
}

/** The elements behind the head, one number after the other; in a text each has a line. */
class Body
{
public:
  Body(std::istream& file, const std::string& format)
    : File(file), IsText(format == "ascii"), IsBig(format == "binary_big_endian")
  {
  }

  void BeginElement()
  {
    std::string line;
    if (this->IsText)
    {
      std::getline(this->File, line);
      // VTK's reader ends the program where the last line does not end.
      this->IsShort = !this->File || this->File.eof();
      this->Line = std::istringstream(line);
    }
  }

  std::uint64_t Count(int bytes)
  {
    if (this->IsText)
    {
      std::string word;
      this->Line >> word;
      return std::strtoull(word.c_str(), nullptr, 10);
    }
    std::string number(static_cast<std::size_t>(bytes), '\0');
    this->File.read(number.data(), bytes);
    return this->File ? NumberOf(number, this->IsBig) : 0;
  }

  /** Go behind the corners of a polygon, which must be among the points. */
  void CheckCorners(std::uint64_t count, const NumberType& type, std::uint64_t points)
  {
    for (std::uint64_t i = 0; this->IsComplete() && i < count; ++i)
    {
      const std::uint64_t corner = this->Count(type.Bytes);
      if ((corner >= points || corner > type.Largest) && this->IsComplete())
      {
        throw Failure("is damaged: a polygon has point " + std::to_string(corner) + ", there are " +
          std::to_string(points));
      }
    }
  }

  void Skip(std::uint64_t count, int bytes)
  {
    std::string word;
    for (std::uint64_t i = 0; this->IsText && this->Line && i < count; ++i)
    {
      this->Line >> word;
    }
    if (!this->IsText)
    {
      const std::uint64_t size = Times(count, static_cast<std::uint64_t>(bytes));
      this->File.ignore(static_cast<std::streamsize>(size));
      this->IsShort = this->IsShort || static_cast<std::uint64_t>(this->File.gcount()) < size;
    }
  }

  /** So far. */
  bool IsComplete() const { return this->File && this->Line && !this->IsShort; }

  /** @throws Failure unless the element has ended, where VTK's reader takes it to end. */
  void EndElement(const std::string& which)
  {
    std::string more;
    FailIf(!this->File || this->IsShort, "the file is cut off: it ends in element " + which);
    FailIf(this->IsText && (!this->Line || this->Line >> more),
      "is damaged: element " + which + " is not in one line of its own");
  }

private:
  std::istream& File;
  std::istringstream Line; ///< that of a text
  bool IsText;
  bool IsBig;
  bool IsShort = false;
};

/** @return the number of points. @throws Failure unless the head has what VTK's reader wants. */
std::uint64_t CheckParts(const Head& head)
{
  static const std::set<std::string> formats = { "ascii", "binary_little_endian",
    "binary_big_endian" };
  FailIf(formats.count(head.Format) == 0,
    "its header is damaged: the format '" + head.Format + "' is none");
  const auto points = std::find_if(head.Parts.begin(), head.Parts.end(),
    [](const Elements& part) { return part.Name == "vertex" && part.Count > 0; });
  FailIf(points == head.Parts.end(), "has no points, or its header is damaged");
  std::set<std::string> names;
  for (const Elements& part : head.Parts)
  {
    std::set<std::string> numbers;
    std::set<std::string> lists;
    for (const Property& property : part.Properties)
    {
      const bool isOfCorners = property.Count.Largest > 0 && property.Value.Largest > 0;
      (property.Count.Bytes == 0 ? numbers : lists)
        .insert(property.Count.Bytes == 0 || isOfCorners ? property.Name : "");
    }
    const bool isRight = part.Name == "vertex"
      ? numbers.count("x") + numbers.count("y") + numbers.count("z") == 3 && lists.empty()
      : part.Name != "face" || lists.count("vertex_indices") + lists.count("vertex_index") == 1;
    // VTK's reader takes what comes before the polygons for points.
    const bool isLate = part.Name == "vertex" ? names.empty() : names.count("vertex") > 0;
    const bool isKnown = part.Name == "vertex" || part.Name == "face" || names.count("face") > 0;
    FailIf(!isLate || !isKnown,
      "its header is damaged, or it is no surface: '" + Shortened(part.Name, 80) +
        "' comes before points or polygons");
    FailIf(!isRight || part.Properties.empty() || !names.insert(part.Name).second,
      "its header is damaged: the properties of '" + part.Name +
        "' are not those of a surface, or it is there twice");
  }
  return points->Count;
}
}

void CheckPly(const std::string& name)
{
  std::ifstream file(name, std::ios::binary);
  const Head head = ReadHead(file);
  Body body(file, head.Format);
  const std::uint64_t points = CheckParts(head);
  for (const Elements& part : head.Parts)
  {
    for (std::uint64_t i = 0; !part.Properties.empty() && i < part.Count; ++i)
    {
      body.BeginElement();
      for (const Property& property : part.Properties)
      {
        const bool isList = property.Count.Bytes > 0;
        const std::uint64_t count = isList ? body.Count(property.Count.Bytes) : 1;
        if (isList && count > property.Count.Largest && body.IsComplete())
        {
          throw Failure("is damaged: a list has less than no values");
        }
        if (isList && part.Name == "face" && property.Name != "texcoord")
        {
          body.CheckCorners(count, property.Value, points);
        }
        else
        {
          body.Skip(count, property.Value.Bytes);
        }
      }
      body.EndElement(std::to_string(i + 1) + " of " + std::to_string(part.Count));
    }
  }
}

// ---- .obj ---------------------------------------------------------------------------------------

// Lines of words. Corners of faces are numbers of points, of texture coordinates and of normals, as
// 1/2/3, 1/2, 1//3 or 1; less than 0 they count from the last one so far.
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

// ---- .vtk ---------------------------------------------------------------------------------------

// Legacy files. Up to version 4 cells are a list of numbers of points, each with the points behind
// it, by which VTK's reader walks; newer ones have offsets, which it looks at.
void CheckLegacy(const std::string& name)
{
  static const std::set<std::string> kinds = { "vertices", "lines", "polygons", "triangle_strips" };
  std::ifstream file(name, std::ios::binary);
  std::string line;
  std::getline(file, line);
  const bool isNew = std::atoi(line.substr(line.find_last_of(' ') + 1).c_str()) >= 5;
  std::getline(std::getline(file, line), line);
  const bool isText = Lower(Trimmed(line)) == "ascii";
  const auto next = [&]
  {
    std::int64_t number = -1;
    std::string bytes(4, '\0');
    if (isText ? !(file >> number) : !file.read(bytes.data(), 4))
    {
      return std::int64_t(-1);
    }
    return isText ? number : std::int64_t(static_cast<std::int32_t>(NumberOf(bytes, true)));
  };
  for (std::string word; !isNew && file >> std::setw(32) >> word;)
  {
    std::int64_t cells = 0;
    std::int64_t left = 0;
    std::string more;
    // An array may have such a name; behind its numbers is a type.
    if (kinds.count(Lower(word)) == 0 || !std::getline(file, line) ||
      !(std::istringstream(line) >> cells >> left) ||
      std::istringstream(line) >> left >> left >> more)
    {
      continue;
    }
    for (std::int64_t i = 0; i < cells; ++i)
    {
      const std::int64_t points = next();
      left -= 1 + points;
      FailIf(points < 0 || left < cells - 1 - i,
        "is cut off or damaged: cell " + std::to_string(i + 1) + " of " + std::to_string(cells) +
          " has " + std::to_string(points) + " points, which are not all there");
      for (std::int64_t k = 0; k < points; ++k)
      {
        next();
      }
    }
    FailIf(left != 0, "is damaged: its " + word + " are more numbers than its cells have");
  }
}
}
