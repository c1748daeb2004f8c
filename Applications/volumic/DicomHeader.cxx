// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DicomHeader.h"

#include "BinaryFile.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace tool
{
namespace
{
const char* const ImplicitLittle = "1.2.840.10008.1.2";
const char* const ExplicitLittle = "1.2.840.10008.1.2.1";
const char* const ExplicitBig = "1.2.840.10008.1.2.2";
const char* const PrivateOfGe = "1.2.840.113619.5.2"; ///< implicit, pixels big-endian

constexpr std::uint32_t Undefined = 0xFFFFFFFFu;

constexpr std::uint32_t Tag(std::uint32_t group, std::uint32_t element)
{
  return group << 16 | element;
}

struct Element
{
  std::uint32_t Tag = 0;
  std::string Kind; ///< its value representation, two letters; empty where it is implicit
  std::uint32_t Length = 0;
};

/** Reads the elements one after the other. */
class ElementStream
{
public:
  explicit ElementStream(const std::string& name)
    : File(name, std::ios::binary), Size(std::filesystem::file_size(name))
  {
    this->File.seekg(132); // preamble and mark
  }

  bool IsExplicit = true;
  bool IsBig = false;

  std::uint64_t At() { return static_cast<std::uint64_t>(this->File.tellg()); }
  void Seek(std::uint64_t place) { this->File.seekg(static_cast<std::streamoff>(place)); }
  std::uint64_t Left() { return this->Size - std::min(this->Size, this->At()); }

  Element Next()
  {
    Element element;
    const std::uint32_t group = this->Number(2);
    element.Tag = Tag(group, this->Number(2));
    if (!this->IsExplicit || group == 0xFFFE)
    {
      element.Length = this->Number(4);
      return element;
    }
    element.Kind = this->Bytes(2);
    static const std::vector<std::string> longKinds = { "OB", "OD", "OF", "OL", "OV", "OW", "SQ",
      "SV", "UC", "UN", "UR", "UT", "UV" };
    const bool isLong =
      std::find(longKinds.begin(), longKinds.end(), element.Kind) != longKinds.end();
    if (isLong)
    {
      this->Number(2);
    }
    element.Length = this->Number(isLong ? 4 : 2);
    return element;
  }

  std::string Bytes(std::uint64_t count)
  {
    FailIf(count > this->Left(), "it is cut off within its header");
    std::string bytes(count, '\0');
    this->File.read(bytes.data(), static_cast<std::streamsize>(count));
    return bytes;
  }

  /** A binary number of 2 or 4 bytes. */
  std::uint32_t Number(int bytes)
  {
    return static_cast<std::uint32_t>(
      NumberOf(this->Bytes(static_cast<std::uint64_t>(bytes)), this->IsBig));
  }

  /** Go behind a value; one of undefined length is a sequence of items, which may hold such. */
  void Skip(const Element& element, int depth = 0)
  {
    if (element.Length != Undefined)
    {
      FailIf(element.Length > this->Left(), "it is cut off within its header");
      this->File.seekg(static_cast<std::streamoff>(element.Length), std::ios::cur);
      return;
    }
    FailIf(depth > 100, "its header is damaged: sequences within sequences without end");
    const bool wasExplicit = this->IsExplicit;
    this->IsExplicit = wasExplicit && element.Kind != "UN"; // PS3.5, 6.2.2
    Element inner = this->Next();
    // The ends of an item and of a sequence.
    while (inner.Tag != Tag(0xFFFE, 0xE00D) && inner.Tag != Tag(0xFFFE, 0xE0DD))
    {
      this->Skip(inner, depth + 1);
      inner = this->Next();
    }
    this->IsExplicit = wasExplicit;
  }

private:
  std::ifstream File;
  std::uint64_t Size;
};

/** Text without the blanks or the zero that make its length even. */
std::string Text(std::string value)
{
  const std::size_t last = value.find_last_not_of(std::string(" \0", 2));
  value.resize(last == std::string::npos ? 0 : last + 1);
  return value;
}

void TakeSyntax(const std::string& syntax, ElementStream& stream)
{
  stream.IsExplicit = syntax == ExplicitLittle || syntax == ExplicitBig;
  stream.IsBig = syntax == ExplicitBig;
  FailIf(!stream.IsExplicit && syntax != ImplicitLittle && syntax != PrivateOfGe,
    "compressed (transfer syntax " + syntax +
      "); uncompress the series first, for example with gdcmconv --raw");
}

/** What the element is called, if vtkDICOMImageReader takes a number from its text; else null. */
const char* NameOfDecimal(const Element& element)
{
  return element.Tag == Tag(0x0020, 0x0032) ? "position"
    : element.Tag == Tag(0x0020, 0x0037)    ? "orientation"
    : element.Tag == Tag(0x0028, 0x0030)    ? "spacing"
    : element.Tag == Tag(0x0018, 0x1164)    ? "imager spacing"
    : element.Tag == Tag(0x0028, 0x1052)    ? "intercept"
    : element.Tag == Tag(0x0028, 0x1053)    ? "slope"
                                            : nullptr;
}

/** @throws Failure if a part of the text, between backslashes, is no number. */
void CheckDecimal(const std::string& text, const char* name)
{
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, '\\');)
  {
    part.erase(std::remove(part.begin(), part.end(), ' '), part.end());
    FailIf(
      !AsNumber<double>(part), std::string("its header is damaged: ") + name + " '" + text + "'");
  }
}

/** Keep the value of the element, or go behind it. */
void Take(const Element& element, ElementStream& stream, DicomHeader& header)
{
  std::string* text = element.Tag == Tag(0x0002, 0x0010) ? &header.Syntax
    : element.Tag == Tag(0x0002, 0x0002)                 ? &header.Class
    : element.Tag == Tag(0x0008, 0x0016)                 ? &header.Class
    : element.Tag == Tag(0x0008, 0x103E)                 ? &header.Description
    : element.Tag == Tag(0x0020, 0x000E)                 ? &header.Series
                                                         : nullptr;
  int* number = element.Tag == Tag(0x0028, 0x0002) ? &header.Samples
    : element.Tag == Tag(0x0028, 0x0010)           ? &header.Rows
    : element.Tag == Tag(0x0028, 0x0011)           ? &header.Columns
    : element.Tag == Tag(0x0028, 0x0100)           ? &header.Bits
                                                   : nullptr;
  if (text && element.Length != Undefined)
  {
    *text = Text(stream.Bytes(element.Length));
  }
  else if (number && element.Length == 2)
  {
    *number = static_cast<int>(stream.Number(2));
  }
  else if (element.Tag == Tag(0x0028, 0x0008) && element.Length != Undefined)
  {
    const std::string frames = Text(stream.Bytes(element.Length));
    header.Frames = frames.empty() ? 1 : std::atoi(frames.c_str());
    FailIf(frames.find_first_not_of("0123456789+ ") != std::string::npos || header.Frames < 1,
      "its header is damaged: the number of frames is '" + frames + "'");
  }
  else if (const char* name = NameOfDecimal(element); name && element.Length != Undefined)
  {
    const std::string numbers = Text(stream.Bytes(element.Length));
    CheckDecimal(numbers, name);
    const bool isGiven = !numbers.empty();
    header.HasSpacing = header.HasSpacing || (isGiven && element.Tag == Tag(0x0028, 0x0030));
    header.ImagerSpacing = element.Tag == Tag(0x0018, 0x1164) ? numbers : header.ImagerSpacing;
    header.HasPosition = header.HasPosition || (isGiven && element.Tag == Tag(0x0020, 0x0032));
    header.HasOrientation =
      header.HasOrientation || (isGiven && element.Tag == Tag(0x0020, 0x0037));
  }
  else
  {
    stream.Skip(element);
  }
}

/** @throws Failure unless there are elements up to the end of the file. */
void CheckBehindPixels(Element element, ElementStream& stream)
{
  try
  {
    stream.Skip(element);
    while (stream.Left() > 0)
    {
      const std::uint32_t former = element.Tag;
      element = stream.Next();
      FailIf(element.Tag <= former, "");
      stream.Skip(element);
    }
  }
  catch (const Failure&)
  {
    throw Failure("is damaged: it does not end behind its pixels, bytes may be too many; copy it "
                  "again");
  }
}
}

std::uint64_t DicomHeader::NeededBytes() const
{
  return static_cast<std::uint64_t>(this->Rows) * static_cast<std::uint64_t>(this->Columns) *
    static_cast<std::uint64_t>(this->Samples) * static_cast<std::uint64_t>(this->Bits / 8);
}

bool DicomHeader::IsOtherThanImage() const
{
  // PS3.4, B.5: waveforms, presentation states, raw data, surfaces, reports, documents, plans.
  static const char* const others[] = { "1.2.840.10008.1.3.10", "1.2.840.10008.5.1.4.1.1.9.",
    "1.2.840.10008.5.1.4.1.1.11.", "1.2.840.10008.5.1.4.1.1.66", "1.2.840.10008.5.1.4.1.1.67",
    "1.2.840.10008.5.1.4.1.1.68", "1.2.840.10008.5.1.4.1.1.88.", "1.2.840.10008.5.1.4.1.1.104.",
    "1.2.840.10008.5.1.4.1.1.481." };
  return !this->HasPixels &&
    std::any_of(std::begin(others), std::end(others),
      [this](const std::string& start)
      { return this->Class.compare(0, start.size(), start) == 0; });
}

DicomHeader ReadDicomHeader(const std::string& file)
{
  DicomHeader header;
  ElementStream stream(file);
  bool isInMeta = true;
  while (stream.Left() > 0)
  {
    // The first group, which tells the encoding of the others, has one of its own.
    if (isInMeta && stream.Left() >= 2)
    {
      const std::uint64_t at = stream.At();
      isInMeta = stream.Number(2) == 2;
      stream.Seek(at);
      if (!isInMeta && !header.Syntax.empty())
      {
        TakeSyntax(header.Syntax, stream);
      }
    }
    const Element element = stream.Next();
    if (element.Tag == Tag(0x7FE0, 0x0010))
    {
      FailIf(
        element.Length == Undefined, "compressed, against its transfer syntax " + header.Syntax);
      header.HasPixels = true;
      header.PixelBytes = std::min<std::uint64_t>(element.Length, stream.Left());
      if (header.PixelBytes == element.Length)
      {
        CheckBehindPixels(element, stream);
      }
      return header;
    }
    Take(element, stream, header);
  }
  return header;
}
}
