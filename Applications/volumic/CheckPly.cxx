// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The polygon file format: a text head tells of elements, and their properties; each property is a
// number, or a list of numbers behind their count.
#include "BinaryFile.h"
#include "ByteBudget.h"
#include "CheckInputs.h"
#include "ToolErrors.h"

#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace tool
{
namespace
{
struct Property
{
  std::string Name;
  int CountBytes = 0; ///< of a list; 0: there is one number
  int Bytes = 0;
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

int TypeBytes(const std::string& type)
{
  static const std::map<std::string, int> sizes = { { "char", 1 }, { "uchar", 1 }, { "int8", 1 },
    { "uint8", 1 }, { "short", 2 }, { "ushort", 2 }, { "int16", 2 }, { "uint16", 2 }, { "int", 4 },
    { "uint", 4 }, { "int32", 4 }, { "uint32", 4 }, { "float", 4 }, { "float32", 4 },
    { "double", 8 }, { "float64", 8 } };
  const auto found = sizes.find(type);
  if (found == sizes.end())
  {
    throw Failure("its header is damaged: '" + type + "' is no type");
  }
  return found->second;
}

/** Read the head; the stream stands behind it. */
Head ReadHead(std::istream& file)
{
  Head head;
  std::string line;
  // VTK's reader has room for 4096 bytes, and takes zeros for the ends of lines.
  constexpr std::size_t longest = 4000;
  while (std::getline(file, line) && line.size() <= longest &&
    line.find('\0') == std::string::npos)
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
      if (!(words >> head.Parts.back().Count) ||
        head.Parts.back().Count > std::numeric_limits<int>::max())
      {
        throw Failure("its header is damaged: no number of elements '" + type + "'");
      }
    }
    else if (word == "property")
    {
      if (head.Parts.empty())
      {
        throw Failure("its header is damaged: a property of no element");
      }
      Property property;
      if (type == "list")
      {
        words >> word >> type;
        property.CountBytes = TypeBytes(word);
      }
      property.Bytes = TypeBytes(type);
      if (!(words >> property.Name))
      {
        throw Failure("its header is damaged: a property has no name");
      }
      head.Parts.back().Properties.push_back(property);
    }
  }
  throw Failure("the file is cut off, or no polygon file: its header does not end");
}

/** The elements behind the head, one number after the other. */
class Body
{
public:
  Body(std::istream& file, const std::string& format)
    : File(file), IsText(format == "ascii"), IsBig(format == "binary_big_endian")
  {
  }

  std::uint64_t Count(int bytes)
  {
    if (this->IsText)
    {
      std::string word;
      this->File >> word;
      return std::strtoull(word.c_str(), nullptr, 10);
    }
    std::string number(static_cast<std::size_t>(bytes), '\0');
    this->File.read(number.data(), bytes);
    return this->File ? NumberOf(number, this->IsBig) : 0;
  }

  /** Go behind the corners of a polygon, which must be among the points. */
  void CheckCorners(std::uint64_t count, int bytes, std::uint64_t points)
  {
    for (std::uint64_t i = 0; this->File && i < count; ++i)
    {
      const std::uint64_t corner = this->Count(bytes);
      if (corner >= points && this->File)
      {
        throw Failure("is damaged: a polygon has point " + std::to_string(corner) + ", there are " +
          std::to_string(points));
      }
    }
  }

  void Skip(std::uint64_t count, int bytes)
  {
    std::string word;
    for (std::uint64_t i = 0; this->IsText && this->File && i < count; ++i)
    {
      this->File >> word;
    }
    if (!this->IsText)
    {
      const std::uint64_t size = Times(count, static_cast<std::uint64_t>(bytes));
      this->File.ignore(static_cast<std::streamsize>(size));
      this->IsShort = this->IsShort || static_cast<std::uint64_t>(this->File.gcount()) < size;
    }
  }

  bool IsComplete() const { return this->File && !this->IsShort; }

private:
  std::istream& File;
  bool IsText;
  bool IsBig;
  bool IsShort = false;
};

/** @return the number of points. @throws Failure unless the head has what VTK's reader wants. */
std::uint64_t CheckParts(const Head& head)
{
  static const std::set<std::string> formats = { "ascii", "binary_little_endian",
    "binary_big_endian" };
  if (formats.count(head.Format) == 0)
  {
    throw Failure("its header is damaged: the format '" + head.Format + "' is none");
  }
  std::uint64_t points = 0;
  std::set<std::string> names;
  for (const Elements& part : head.Parts)
  {
    std::set<std::string> numbers;
    std::set<std::string> lists;
    for (const Property& property : part.Properties)
    {
      (property.CountBytes > 0 ? lists : numbers).insert(property.Name);
    }
    const bool isRight = part.Name == "vertex"
      ? numbers.count("x") + numbers.count("y") + numbers.count("z") == 3 && lists.empty()
      : part.Name != "face" || lists.count("vertex_indices") + lists.count("vertex_index") == 1;
    if (!isRight || part.Properties.empty() || !names.insert(part.Name).second)
    {
      throw Failure("its header is damaged: the properties of '" + part.Name +
        "' are not those of a surface, or it is there twice");
    }
    points = part.Name == "vertex" ? part.Count : points;
  }
  if (points == 0)
  {
    throw Failure("has no points, or its header is damaged");
  }
  return points;
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
      for (const Property& property : part.Properties)
      {
        const bool isList = property.CountBytes > 0;
        const std::uint64_t count = isList ? body.Count(property.CountBytes) : 1;
        if (isList && part.Name == "face" && property.Name != "texcoord")
        {
          body.CheckCorners(count, property.Bytes, points);
        }
        else
        {
          body.Skip(count, property.Bytes);
        }
      }
      if (!body.IsComplete())
      {
        throw Failure("the file is cut off: it ends in element " + std::to_string(i + 1) + " of " +
          std::to_string(part.Count));
      }
    }
  }
}
}
