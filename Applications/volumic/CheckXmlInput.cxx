// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// VTK's files of XML (its documentation: VTK File Formats). Arrays are in their elements or behind
// all, appended; if they are packed, they begin with the number of blocks.
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ReadVolume.h"
#include "ToolErrors.h"

#include <vtkBase64Utilities.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkXMLParser.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace tool
{
namespace
{
/** Reads what VTK's readers do, by the same parser, and keeps next to nothing. */
class XmlMeter : public vtkXMLParser
{
public:
  static XmlMeter* New();
  vtkTypeMacro(XmlMeter, vtkXMLParser);

  bool IsTooDeep = false;
  bool IsPacked = false;
  bool IsBig = false;
  bool IsRaw = false; ///< what is appended; else in base64
  int WordBytes = 4;  ///< of numbers before arrays
  std::int64_t Appended = -1;        ///< where the element begins
  std::vector<std::int64_t> Inline;  ///< where elements begin that hold an array
  std::vector<std::int64_t> Offsets; ///< of arrays in what is appended

protected:
  void StartElement(const char* name, const char** attributes) override
  {
    constexpr int deepest = 100;
    this->IsTooDeep = this->IsTooDeep || ++this->Depth > deepest;
    const auto is = [attributes, this](const char* key, const char* value)
    { return std::strcmp(this->Attribute(attributes, key), value) == 0; };
    if (std::strcmp(name, "VTKFile") == 0)
    {
      this->IsPacked = *this->Attribute(attributes, "compressor") != '\0';
      this->IsBig = is("byte_order", "BigEndian");
      this->WordBytes = is("header_type", "UInt64") ? 8 : 4;
    }
    if (std::strcmp(name, "AppendedData") == 0 && this->Appended < 0)
    {
      this->Appended = static_cast<std::int64_t>(this->GetXMLByteIndex());
      this->IsRaw = is("encoding", "raw");
    }
    else if (!is("offset", "")) // whatever the format
    {
      this->Offsets.push_back(std::atoll(this->Attribute(attributes, "offset")));
    }
    else if (is("format", "binary"))
    {
      this->Inline.push_back(static_cast<std::int64_t>(this->GetXMLByteIndex()));
    }
  }
  void EndElement(const char*) override { --this->Depth; }
  /** What is appended is no XML. */
  int ParsingComplete() override { return this->IsTooDeep || this->Appended >= 0 ? 1 : 0; }
  void ReportXmlParseError() override {} // VTK's reader tells of it.

private:
  const char* Attribute(const char** attributes, const char* key) const
  {
    while (*attributes && std::strcmp(*attributes, key) != 0)
    {
      attributes += 2;
    }
    return *attributes ? attributes[1] : "";
  }

  int Depth = 0;
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

/** The three numbers that come next, as they are or in base64; zeros if none do. */
std::array<std::uint64_t, 3> NextNumbers(std::istream& file, const XmlMeter& meter, bool isRaw)
{
  const auto bytes = static_cast<std::size_t>(meter.WordBytes);
  // Of base64 four signs are three bytes.
  std::string words(isRaw ? 3 * bytes : 4 * bytes, '\0');
  file.read(words.data(), static_cast<std::streamsize>(words.size()));
  static const std::string signs =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::size_t there = static_cast<std::size_t>(file.gcount());
  there = isRaw ? there : std::min(there, words.find_first_not_of(signs));
  if (there * (isRaw ? 8 : 6) < bytes * 8)
  {
    return { 0, 0, 0 };
  }
  const bool isWhole = there >= words.size(); // else the first number is all that is known
  words.replace(there, std::string::npos, words.size() - std::min(there, words.size()), 'A');
  if (!isRaw)
  {
    std::string decoded(3 * bytes, '\0');
    vtkBase64Utilities::DecodeSafely(reinterpret_cast<const unsigned char*>(words.data()),
      words.size(), reinterpret_cast<unsigned char*>(decoded.data()), decoded.size());
    words = decoded;
  }
  const auto number = [&](std::size_t which)
  { return NumberOf(words.substr(which * bytes, bytes), meter.IsBig); };
  return { number(0), isWhole ? number(1) : 1, isWhole ? number(2) : 0 };
}

/** @throws Failure if an array has more blocks than the file has room for, or impossible sizes. */
void CheckBlocks(std::istream& file, const XmlMeter& meter)
{
  file.clear();
  file.seekg(0, std::ios::end);
  const std::uint64_t most =
    static_cast<std::uint64_t>(file.tellg()) / static_cast<std::uint64_t>(meter.WordBytes);
  const auto check = [&](bool isRaw)
  {
    // The last block may be smaller.
    const auto [blocks, size, last] = NextNumbers(file, meter, isRaw);
    FailIf(blocks > most || last > size || (blocks > 0 ? size == 0 : last > 0),
      "it is damaged: an array is packed in " + std::to_string(blocks) + " blocks of " +
        std::to_string(size) + " bytes, the last one of " + std::to_string(last));
  };
  for (const std::int64_t place : meter.Inline)
  {
    GoBehindTag(file, place);
    file >> std::ws;
    check(false);
  }
  if (meter.Appended >= 0)
  {
    GoBehindTag(file, meter.Appended);
    file.ignore(std::numeric_limits<std::streamsize>::max(), '_');
    const std::int64_t start = file.tellg();
    for (const std::int64_t offset : meter.Offsets)
    {
      file.clear();
      if (start >= 0 && offset >= 0 && offset < std::numeric_limits<std::int64_t>::max() - start)
      {
        file.seekg(start + offset);
        check(meter.IsRaw);
      }
    }
  }
}
}

void CheckXmlInput(std::istream& file)
{
  const auto meter = vtkSmartPointer<XmlMeter>::New();
  meter->SetStream(&file);
  meter->SetIgnoreCharacterData(1);
  meter->Parse();
  FailIf(meter->IsTooDeep, "it is damaged: elements within elements without end");
  if (meter->IsPacked)
  {
    CheckBlocks(file, *meter);
  }
}

void CheckXmlInput(const std::string& name)
{
  for (const std::string& part : FilesOfVolume(name))
  {
    std::ifstream file(part, std::ios::binary);
    CheckXmlInput(file);
  }
}
}
