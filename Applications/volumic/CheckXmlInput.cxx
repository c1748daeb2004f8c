// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// VTK's files of XML (its documentation: VTK File Formats). Arrays are in their elements, as numbers
// or in base64, or behind all, appended; if they are packed, they begin with the number of blocks.
// Where an array has less than its place asks for, VTK's readers give zeros.
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ReadVolume.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkBase64Utilities.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkXMLParser.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace tool
{
namespace
{
/** An array, as its element tells of it. */
struct XmlArray
{
  std::string Name;
  std::int64_t Place = 0; ///< of its element; of an appended one behind the first byte of all
  bool IsAppended = false;
  bool IsText = false;
  bool IsOfCorners = false;            ///< the points of polygons, however many there are
  std::uint64_t Bytes = 0;             ///< of a number; 0: they are texts, or bits
  std::optional<std::uint64_t> Values; ///< that there must be, if that is known
};

/** Reads what VTK's readers do, by the same parser, and keeps next to nothing. */
class XmlMeter : public vtkXMLParser
{
public:
  static XmlMeter* New();
  vtkTypeMacro(XmlMeter, vtkXMLParser);

  bool IsTooDeep = false;
  bool IsPacked = false;
  bool IsBig = false;
  bool IsRaw = false;         ///< what is appended; else in base64
  std::size_t WordBytes = 4;  ///< of numbers before arrays
  std::int64_t Appended = -1; ///< where the element begins
  std::vector<XmlArray> Arrays;

protected:
  void StartElement(const char* name, const char** attributes) override
  {
    constexpr int deepest = 100;
    this->IsTooDeep = this->IsTooDeep || ++this->Depth > deepest;
    const auto text = [attributes](const char* key)
    {
      const char** each = attributes;
      for (; *each && std::strcmp(*each, key) != 0; each += 2)
      {
      }
      return std::string(*each ? each[1] : "");
    };
    const std::string kind = name;
    if (kind == "VTKFile")
    {
      this->IsPacked = !text("compressor").empty();
      this->IsBig = text("byte_order") == "BigEndian";
      this->WordBytes = text("header_type") == "UInt64" ? 8 : 4;
    }
    else if (kind == "AppendedData" && this->Appended < 0)
    {
      this->Appended = static_cast<std::int64_t>(this->GetXMLByteIndex());
      this->IsRaw = text("encoding") == "raw";
    }
    else if (kind == "DataArray" || kind == "Array")
    {
      this->AddArray(text);
    }
    else if (!text("WholeExtent").empty())
    {
      this->Whole = ExtentOf(text("WholeExtent"));
    }
    else if (kind == "Piece")
    {
      this->CountPiece(text);
    }
    else
    {
      this->Section = kind;
    }
  }
  void EndElement(const char*) override { --this->Depth; }
  /** What is appended is no XML. */
  int ParsingComplete() override { return this->IsTooDeep || this->Appended >= 0 ? 1 : 0; }
  void ReportXmlParseError() override {} // VTK's reader tells of it.

private:
  using Extent = std::array<std::int64_t, 6>;

  static Extent ExtentOf(const std::string& text)
  {
    Extent extent = { 0, -1, 0, -1, 0, -1 };
    std::istringstream words(text);
    for (std::int64_t& end : extent)
    {
      words >> end;
    }
    return extent;
  }

  static std::uint64_t Number(const std::string& text)
  {
    return std::strtoull(text.c_str(), nullptr, 10);
  }

  /** How many values arrays of the sections of this piece have. */
  template <class Text>
  void CountPiece(const Text& text)
  {
    this->Counts.clear();
    if (text("Extent").empty())
    {
      this->Counts["PointData"] = this->Counts["Points"] = Number(text("NumberOfPoints"));
      for (const char* cells : { "Verts", "Lines", "Strips", "Polys" })
      {
        this->Counts[cells] = Number(text((std::string("NumberOf") + cells).c_str()));
        this->Counts["CellData"] += this->Counts[cells];
      }
      return;
    }
    const Extent extent = ExtentOf(text("Extent"));
    std::uint64_t points = 1;
    std::uint64_t cells = 1;
    for (std::size_t a = 0; a < 6; a += 2)
    {
      const auto steps = static_cast<std::uint64_t>(std::max<std::int64_t>(extent[a + 1] - extent[a], -1));
      points = Times(points, steps + 1);
      // A flat image has a layer of cells.
      cells = Times(cells, steps == 0 && this->Whole[a] == this->Whole[a + 1] ? 1 : steps);
    }
    this->Counts["PointData"] = points;
    this->Counts["CellData"] = points == 0 ? 0 : cells;
  }

  template <class Text>
  void AddArray(const Text& text)
  {
    static const std::map<std::string, std::uint64_t> bytes = { { "Int8", 1 }, { "UInt8", 1 },
      { "Int16", 2 }, { "UInt16", 2 }, { "Int32", 4 }, { "UInt32", 4 }, { "Int64", 8 },
      { "UInt64", 8 }, { "Float32", 4 }, { "Float64", 8 } };
    XmlArray array;
    array.Name = text("Name");
    array.Bytes = EntryOr(bytes, text("type"), 0);
    const std::string offset = text("offset"); // whatever the format
    array.IsAppended = !offset.empty();
    array.IsText = !array.IsAppended && text("format") != "binary";
    array.Place = array.IsAppended ? std::atoll(offset.c_str())
                                   : static_cast<std::int64_t>(this->GetXMLByteIndex());
    const auto counted = this->Counts.find(this->Section);
    const std::string components = text("NumberOfComponents");
    const std::uint64_t each = components.empty() ? 1 : Number(components);
    array.IsOfCorners = array.Name == "connectivity" && counted != this->Counts.end();
    if (this->Section == "FieldData" && !text("NumberOfTuples").empty())
    {
      array.Values = Times(Number(text("NumberOfTuples")), each);
    }
    else if (counted != this->Counts.end() && !array.IsOfCorners)
    {
      array.Values = Times(counted->second, each);
    }
    this->Arrays.push_back(array);
  }

  int Depth = 0;
  Extent Whole = { 0, -1, 0, -1, 0, -1 };
  std::string Section; ///< the last element that is none of an array
  std::map<std::string, std::uint64_t> Counts;
};

vtkStandardNewMacro(XmlMeter);

/** Goes behind the opening tag that begins at a place. */
void GoBehindTag(std::istream& file, std::int64_t place)
{
  file.clear();
  file.seekg(place);
  int quote = 0;
  for (int c = file.get(); file && (quote != 0 || c != '>'); c = file.get())
  {
    quote = quote == 0 && (c == '"' || c == '\'') ? c : quote == c ? 0 : quote;
  }
}

std::uint64_t Base64Signs(std::uint64_t bytes)
{
  return (bytes + 2) / 3 * 4;
}

/** So many numbers from a place on, as they are or in base64; none if they are not all there. */
std::vector<std::uint64_t> WordsAt(
  std::istream& file, std::int64_t place, const XmlMeter& meter, bool isRaw, std::size_t count)
{
  const std::size_t bytes = count * meter.WordBytes;
  std::string text(isRaw ? bytes : static_cast<std::size_t>(Base64Signs(bytes)), '\0');
  file.clear();
  file.seekg(place);
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())))
  {
    return {};
  }
  if (!isRaw)
  {
    std::string decoded(bytes + 2, '\0');
    const std::size_t there = vtkBase64Utilities::DecodeSafely(
      reinterpret_cast<const unsigned char*>(text.data()), text.size(),
      reinterpret_cast<unsigned char*>(decoded.data()), decoded.size());
    if (there < bytes)
    {
      return {};
    }
    text = decoded;
  }
  std::vector<std::uint64_t> words;
  for (std::size_t i = 0; i < count; ++i)
  {
    words.push_back(NumberOf(text.substr(i * meter.WordBytes, meter.WordBytes), meter.IsBig));
  }
  return words;
}

/** What the numbers before an array tell. */
struct Told
{
  std::uint64_t Bytes = 0; ///< unpacked
  std::uint64_t Length = 0; ///< of all in the file
};

/** @throws Failure if an array has more blocks than the file has room for, or impossible sizes. */
Told ReadToldBytes(std::istream& file, std::int64_t place, const XmlMeter& meter, bool isRaw)
{
  const auto length = [isRaw](std::uint64_t bytes) { return isRaw ? bytes : Base64Signs(bytes); };
  const std::vector<std::uint64_t> first = WordsAt(file, place, meter, isRaw, 1);
  FailIf(first.empty(), "the file is cut off or damaged: an array has no number of bytes before it");
  if (!meter.IsPacked)
  {
    const std::uint64_t most = std::numeric_limits<std::int64_t>::max() / 4;
    FailIf(first[0] > most, "it is damaged: an array of " + std::to_string(first[0]) + " bytes");
    return { first[0], length(meter.WordBytes + first[0]) };
  }
  file.clear();
  file.seekg(0, std::ios::end);
  const auto all = static_cast<std::uint64_t>(file.tellg());
  const std::vector<std::uint64_t> three = WordsAt(file, place, meter, isRaw, 3);
  const std::uint64_t blocks = first[0];
  const std::uint64_t size = three.empty() ? 0 : three[1];
  const std::uint64_t last = three.empty() ? 0 : three[2]; // 0: as large as the others
  FailIf(blocks > all / meter.WordBytes || last > size || (blocks > 0 ? size == 0 : last > 0),
    "it is damaged: an array is packed in " + std::to_string(blocks) + " blocks of " +
      std::to_string(size) + " bytes, the last one of " + std::to_string(last));
  if (blocks == 0)
  {
    return {};
  }
  const std::size_t words = 3 + static_cast<std::size_t>(blocks);
  const std::vector<std::uint64_t> sizes = WordsAt(file, place, meter, isRaw, words);
  std::uint64_t packed = 0;
  for (std::size_t i = 3; i < sizes.size(); ++i)
  {
    packed += std::min(sizes[i], all);
  }
  FailIf(sizes.empty() || packed > all, "the file is cut off or damaged within its packed arrays");
  return { Times(last > 0 ? blocks - 1 : blocks, size) + last,
    length(words * meter.WordBytes) + length(packed) };
}

std::string NameOf(const XmlArray& array)
{
  return "its array '" + Shortened(array.Name, 80) + "'";
}

/** How many numbers an array of text has. @throws Failure for what VTK's reader takes for its end. */
std::uint64_t CountNumbers(std::istream& file, const XmlArray& array)
{
  GoBehindTag(file, array.Place);
  constexpr int longest = 512;
  std::uint64_t count = 0;
  for (std::string word; file >> std::setw(longest) >> word;)
  {
    const std::size_t end = word.find('<');
    const std::string number = word.substr(0, end);
    FailIf(number.find_first_not_of("0123456789+-.eE") != std::string::npos && array.Bytes > 0,
      NameOf(array) + " has '" + Shortened(number, 40) + "', where VTK's reader ends; write it binary");
    count += number.empty() ? 0 : 1;
    if (end != std::string::npos)
    {
      return count;
    }
  }
  throw Failure("the file is cut off within " + NameOf(array));
}

/** @throws Failure unless there are so many signs of base64 from a place on, and no more. */
void CheckSigns(std::istream& file, std::int64_t place, std::uint64_t count, const XmlArray& array)
{
  static const std::string signs =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  std::array<bool, 256> isSign{};
  std::for_each(signs.begin(), signs.end(), [&](unsigned char c) { isSign[c] = true; });
  file.clear();
  file.seekg(place);
  std::string piece(1 << 16, '\0');
  for (std::uint64_t left = count; left > 0;)
  {
    const std::size_t some = static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size()));
    file.read(piece.data(), static_cast<std::streamsize>(some));
    FailIf(!file ||
        !std::all_of(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(some),
          [&](unsigned char c) { return isSign[c]; }),
      "the file is cut off or damaged within " + NameOf(array));
    left -= some;
  }
  file >> std::ws;
  FailIf(!array.IsAppended && file.peek() != '<', "it is damaged: " + NameOf(array) + " goes on behind its end");
}

/** Where what is appended begins; -1: nowhere. */
std::int64_t StartOfAppended(std::istream& file, const XmlMeter& meter)
{
  GoBehindTag(file, meter.Appended);
  file.ignore(std::numeric_limits<std::streamsize>::max(), '_');
  return file ? static_cast<std::int64_t>(file.tellg()) : -1;
}

/** @throws Failure unless appended arrays lie one behind the other up to the end of their element. */
void CheckPlaces(std::istream& file, std::map<std::int64_t, std::int64_t>& ends)
{
  std::int64_t end = 0;
  for (const auto& [begin, own] : ends)
  {
    FailIf(begin < end, "it is damaged: two of its arrays overlap at byte " + std::to_string(begin));
    end = own;
  }
  file.clear();
  file.seekg(end);
  std::string tag;
  file >> std::ws >> std::setw(14) >> tag;
  FailIf(end > 0 && tag != "</AppendedData",
    "the file is cut off or damaged: its arrays end at byte " + std::to_string(end) +
      ", where its data do not");
}

/** @return the points that all polygons have together. @throws Failure if anything is missing. */
std::uint64_t CheckArrays(std::istream& file, const XmlMeter& meter)
{
  const std::int64_t start = meter.Appended >= 0 ? StartOfAppended(file, meter) : -1;
  std::map<std::int64_t, std::int64_t> ends; // of appended arrays that begin there
  std::uint64_t corners = 0;
  for (const XmlArray& array : meter.Arrays)
  {
    std::uint64_t there = 0;
    const std::uint64_t bytes = array.IsText ? 1 : std::max<std::uint64_t>(array.Bytes, 1);
    if (array.IsText)
    {
      there = CountNumbers(file, array);
    }
    else
    {
      FailIf(array.IsAppended && (start < 0 || array.Place < 0 || array.Place > std::numeric_limits<std::int64_t>::max() - start),
        "the file is cut off or damaged: " + NameOf(array) + " is not there");
      const bool isRaw = array.IsAppended && meter.IsRaw;
      GoBehindTag(file, array.Place);
      file >> std::ws;
      const std::int64_t place =
        array.IsAppended ? start + array.Place : static_cast<std::int64_t>(file.tellg());
      const bool isEmpty = !array.IsAppended && (place < 0 || file.peek() == '<');
      const Told told = isEmpty ? Told() : ReadToldBytes(file, place, meter, isRaw);
      there = told.Bytes / bytes;
      FailIf(told.Bytes % bytes != 0, "it is damaged: " + NameOf(array) + " ends within a number");
      if (!isRaw && told.Length > 0)
      {
        CheckSigns(file, place, told.Length, array);
      }
      if (array.IsAppended && told.Length > 0)
      {
        ends[place] = std::max(ends[place], place + static_cast<std::int64_t>(told.Length));
      }
    }
    corners += array.IsOfCorners ? there : 0;
    const bool isKnown = array.Values && array.Bytes > 0;
    FailIf(isKnown && there != *array.Values,
      "the file is cut off or damaged: " + NameOf(array) + " has " + std::to_string(there) +
        " values, " + std::to_string(array.Values.value_or(0)) + " are needed");
  }
  if (!ends.empty())
  {
    CheckPlaces(file, ends);
  }
  return corners;
}
}

std::uint64_t CheckXmlInput(std::istream& file)
{
  const auto meter = vtkSmartPointer<XmlMeter>::New();
  meter->SetStream(&file);
  meter->SetIgnoreCharacterData(1);
  meter->Parse(); // VTK's reader tells of what is no XML.
  FailIf(meter->IsTooDeep, "it is damaged: elements within elements without end");
  return CheckArrays(file, *meter);
}

std::uint64_t CheckXmlInput(const std::string& name)
{
  std::uint64_t corners = 0;
  for (const std::string& part : FilesOfVolume(name))
  {
    std::ifstream file(part, std::ios::binary);
    corners += CheckXmlInput(file);
  }
  return corners;
}
}
