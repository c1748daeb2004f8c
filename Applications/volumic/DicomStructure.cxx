// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The elements of a DICOM file (PS3.5, sections 7 and A.4). GDCM ends the program where they don't
// fit together, and takes memory for whatever length an element tells of.
#include "BinaryFile.h"
#include "DicomFiles.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cctype>

namespace tool
{
namespace
{
constexpr std::uint32_t Undefined = 0xFFFFFFFFu;
constexpr std::uint32_t PixelTag = 0x7FE00010u;
constexpr std::uint32_t Item = 0xFFFEE000u;
constexpr std::uint32_t ItemEnd = 0xFFFEE00Du;
constexpr std::uint32_t SequenceEnd = 0xFFFEE0DDu;

struct Part
{
  std::uint32_t Tag = 0;
  std::string Kind; ///< its value representation, two letters; empty where it is implicit
  std::uint32_t Length = 0;
  std::uint64_t Start = 0; ///< of its value
};

/** Goes through a file from element to element. All throws a Failure where something does not fit.
 */
class Walk
{
public:
  explicit Walk(const std::string& name) : File(name) {}

  void CheckAll()
  {
    this->At = 132; // behind preamble and mark
    std::string syntax;
    const std::uint64_t end = this->File.Size();
    while (this->At + 2 <= end && this->File.Number(this->At, 2) == 2)
    {
      const Part element = this->Next(end);
      FailIf(element.Length == Undefined, "its header is damaged");
      if (element.Tag == 0x00020010u)
      {
        syntax = this->File.Text(element.Start, element.Length);
        syntax.resize(std::min(syntax.size(), syntax.find_last_not_of(std::string(" \0", 2)) + 1));
      }
      this->Go(element, end);
    }
    FailIf(syntax == "1.2.840.10008.1.2.1.99",
      "compressed as a whole (transfer syntax " + syntax +
        "); uncompress the series first, for example with gdcmconv --raw");
    this->IsExplicit = syntax != "1.2.840.10008.1.2" && syntax != "1.2.840.113619.5.2";
    this->File.IsBig = syntax == "1.2.840.10008.1.2.2";
    FailIf(this->At >= end, "has no pixels: it is cut off behind its header");
    bool hasPixels = false;
    std::uint32_t former = 0;
    try
    {
      while (this->At < end)
      {
        const Part element = this->Next(end);
        // Behind the pixels bytes that are too many seldom are in order.
        FailIf((hasPixels && element.Tag <= former) || element.Tag >> 16 >= 0xFFFEu,
          "its header is damaged: element " + this->Name(element) + " is out of order");
        former = element.Tag;
        this->CheckValue(element, end, 0);
        hasPixels = hasPixels || element.Tag == PixelTag;
      }
    }
    catch (const Failure&)
    {
      FailIf(hasPixels,
        "is damaged: it does not end behind its pixels, bytes may be too many; copy "
        "it again");
      throw;
    }
  }

private:
  static std::string Name(const Part& element)
  {
    char text[16];
    std::snprintf(text, sizeof(text), "%04X,%04X", element.Tag >> 16, element.Tag & 0xFFFFu);
    return text;
  }

  void Need(std::uint64_t count, std::uint64_t end) const
  {
    FailIf(this->At > end || count > end - this->At, "it is cut off within its header");
  }

  std::uint32_t Number(int bytes, std::uint64_t end)
  {
    this->Need(static_cast<std::uint64_t>(bytes), end);
    this->At += static_cast<std::uint64_t>(bytes);
    return static_cast<std::uint32_t>(
      this->File.Number(this->At - static_cast<std::uint64_t>(bytes), bytes));
  }

  Part Next(std::uint64_t end)
  {
    Part element;
    element.Tag = this->Number(2, end) << 16;
    element.Tag |= this->Number(2, end);
    if (!this->IsExplicit || element.Tag >> 16 == 0xFFFEu)
    {
      element.Length = this->Number(4, end);
    }
    else
    {
      this->Need(2, end);
      element.Kind = this->File.Text(this->At, 2);
      this->At += 2;
      static const std::string longKinds = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";
      static const std::string kinds =
        longKinds + "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US ";
      FailIf(kinds.find(element.Kind + " ") == std::string::npos,
        "its header is damaged: element " + this->Name(element) + " is of no known kind");
      const bool isLong = longKinds.find(element.Kind + " ") != std::string::npos;
      if (isLong)
      {
        this->Number(2, end);
      }
      element.Length = this->Number(isLong ? 4 : 2, end);
    }
    element.Start = this->At;
    return element;
  }

  void Go(const Part& element, std::uint64_t end)
  {
    FailIf(element.Length > end - element.Start,
      element.Tag == PixelTag ? "the pixels are cut off: " + std::to_string(end - element.Start) +
          " bytes, " + std::to_string(element.Length) + " needed; copy the file again"
                              : "it is cut off within its header");
    this->At = element.Start + element.Length;
  }

  /** Go behind the value, within which all must fit as well. */
  void CheckValue(const Part& element, std::uint64_t end, int depth)
  {
    FailIf(depth > 100, "its header is damaged: sequences within sequences without end");
    if (element.Length != Undefined && element.Kind != "SQ" &&
      (this->IsExplicit || !this->HasItems(element, end)))
    {
      this->Go(element, end);
      return;
    }
    const bool isEndless = element.Length == Undefined;
    FailIf(!isEndless && element.Length > end - element.Start, "it is cut off within its header");
    const std::uint64_t last = isEndless ? end : element.Start + element.Length;
    const bool wasExplicit = this->IsExplicit;
    this->IsExplicit = wasExplicit && element.Kind != "UN"; // PS3.5, 6.2.2
    while (isEndless || this->At < last)
    {
      const Part item = this->Next(last);
      if (isEndless && item.Tag == SequenceEnd)
      {
        break;
      }
      FailIf(item.Tag != Item,
        "its header is damaged: sequence " + this->Name(element) + " holds no items");
      if (element.Tag == PixelTag)
      {
        FailIf(item.Length == Undefined, "its packed pixels are damaged");
        this->Go(item, last);
      }
      else
      {
        this->CheckItem(item, last, depth + 1);
      }
    }
    this->IsExplicit = wasExplicit;
  }

  void CheckItem(const Part& item, std::uint64_t end, int depth)
  {
    const bool isEndless = item.Length == Undefined;
    FailIf(!isEndless && item.Length > end - item.Start, "it is cut off within its header");
    const std::uint64_t last = isEndless ? end : item.Start + item.Length;
    while (isEndless || this->At < last)
    {
      const Part inner = this->Next(last);
      if (isEndless && inner.Tag == ItemEnd)
      {
        return;
      }
      FailIf(inner.Tag >> 16 >= 0xFFFEu, "its header is damaged: an item does not end");
      this->CheckValue(inner, last, depth);
    }
  }

  /** Whether a value of implicit kind begins as a sequence does, which GDCM takes it for then. */
  bool HasItems(const Part& element, std::uint64_t end)
  {
    return element.Length >= 8 && element.Length <= end - element.Start &&
      (this->File.Number(element.Start, 2) << 16 | this->File.Number(element.Start + 2, 2)) == Item;
  }

  BinaryFile File;
  std::uint64_t At = 0;
  bool IsExplicit = true;
};
}

void CheckDicom(const std::string& file)
{
  Walk(file).CheckAll();
}
}
