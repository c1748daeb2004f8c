// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// VTK's files of XML (its documentation: VTK File Formats). Arrays are in their elements, as
// numbers or in base64, or behind all, appended; if they are packed, they begin with the number of
// blocks. Where an array has less than its place asks for, VTK's readers give zeros.
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ReadVolume.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "XmlMeter.h"

#include <vtkBase64Utilities.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cctype>
#include <iomanip>
#include <limits>
#include <map>

namespace tool
{
vtkStandardNewMacro(XmlMeter);

namespace
{
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
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::string decoded = isRaw ? text : std::string(bytes + 2, '\0');
  const std::size_t there = isRaw
    ? bytes
    : vtkBase64Utilities::DecodeSafely(reinterpret_cast<const unsigned char*>(text.data()),
        text.size(), reinterpret_cast<unsigned char*>(decoded.data()), decoded.size());
  if (!file || there < bytes)
  {
    return {};
  }
  std::vector<std::uint64_t> words;
  for (std::size_t i = 0; i < count; ++i)
  {
    words.push_back(NumberOf(decoded.substr(i * meter.WordBytes, meter.WordBytes), meter.IsBig));
  }
  return words;
}

/** What the numbers before an array tell. */
struct Told
{
  std::uint64_t Bytes = 0;  ///< unpacked
  std::uint64_t Length = 0; ///< of all in the file
};

/** @throws Failure if an array has more blocks than the file has room for, or impossible sizes. */
Told ReadToldBytes(std::istream& file, std::int64_t place, const XmlMeter& meter, bool isRaw)
{
  const auto length = [isRaw](std::uint64_t bytes) { return isRaw ? bytes : Base64Signs(bytes); };
  const std::vector<std::uint64_t> first = WordsAt(file, place, meter, isRaw, 1);
  FailIf(
    first.empty(), "the file is cut off or damaged: an array has no number of bytes before it");
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

/** How many numbers an array of text has. @throws Failure for what VTK's reader takes for its end.
 */
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
      NameOf(array) + " has '" + Shortened(number, 40) +
        "', where VTK's reader ends; write it binary");
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
  file.clear();
  file.seekg(place);
  const auto isSign = [](int c)
  { return std::isalnum(c) != 0 || c == '+' || c == '/' || c == '='; };
  while (count > 0 && isSign(file.rdbuf()->sbumpc())) // a stream's own get() is slow
  {
    --count;
  }
  FailIf(count > 0 || (!array.IsAppended && (file >> std::ws).peek() != '<'),
    "the file is cut off or damaged within " + NameOf(array));
}

/** @throws Failure unless appended arrays lie one behind the other up to the end of their element.
 */
void CheckPlaces(std::istream& file, std::map<std::int64_t, std::int64_t>& ends)
{
  std::int64_t end = 0;
  for (const auto& [begin, own] : ends)
  {
    FailIf(
      begin < end, "it is damaged: two of its arrays overlap at byte " + std::to_string(begin));
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
  std::int64_t start = -1;
  if (meter.Appended >= 0)
  {
    GoBehindTag(file, meter.Appended);
    file.ignore(std::numeric_limits<std::streamsize>::max(), '_');
    start = file.tellg();
  }
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
      const std::int64_t most = std::numeric_limits<std::int64_t>::max();
      FailIf(array.IsAppended && (start < 0 || array.Place < 0 || array.Place > most - start),
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
