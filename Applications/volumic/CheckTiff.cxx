// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// TIFF 6.0, and BigTIFF, which has wider numbers. libtiff divides by what a damaged page says and
// takes a chain of pages that ends early for a whole one; vtkTIFFReader takes all pages to be like
// the first one, and gives other bytes than those of the file for some kinds of pixels.
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ToolErrors.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

namespace tool
{
namespace
{
enum Tag : std::uint64_t
{
  Kind = 254,
  Width = 256,
  Height = 257,
  Bits = 258,
  Packing = 259,
  Colours = 262,
  Description = 270,
  Offsets = 273,
  Orientation = 274,
  Samples = 277,
  ResolutionX = 282,
  ResolutionY = 283,
  RowsPerStrip = 278,
  Sizes = 279,
  Planes = 284,
  Predictor = 317,
  ColourMap = 320,
  TileWidth = 322,
  Inner = 330, ///< pages that are parts of a page
  Format = 339,
  Exif = 34665,
  Gps = 34853
};

using Numbers = std::vector<std::uint64_t>;

/** Bytes of the file that something uses: from the first to behind the last. */
struct Part
{
  std::uint64_t Begin;
  std::uint64_t End;
  auto Both() const { return std::tie(this->Begin, this->End); }
  bool operator<(const Part& other) const { return this->Both() < other.Both(); }
  bool operator==(const Part& other) const { return this->Both() == other.Both(); }
};

/** A directory of tags, which most often is that of a page. */
struct Page
{
  std::map<std::uint64_t, Numbers> Values; ///< of each tag; empty for others than whole numbers
  std::string Words;       ///< of the description
  std::vector<Part> Parts; ///< of the file: itself, the values elsewhere
  std::uint64_t Next = 0;

  bool Has(Tag tag) const { return this->Values.count(tag) > 0; }

  /** The only number of a tag, or, as some have one for each sample, of all alike. */
  std::uint64_t Number(Tag tag, std::uint64_t otherwise) const
  {
    if (!this->Has(tag))
    {
      return otherwise;
    }
    const Numbers& values = this->Values.at(tag);
    if (values.empty() || std::count(values.begin(), values.end(), values[0]) !=
        static_cast<std::ptrdiff_t>(values.size()))
    {
      throw Failure("its tag " + std::to_string(tag) + " is no number");
    }
    return values[0];
  }

  /** What lies between pixels of a resolution. */
  double Distance(Tag tag) const
  {
    const Numbers values = this->List(tag);
    return values.size() == 2 && values[0] > 0 && values[1] > 0
      ? static_cast<double>(values[1]) / static_cast<double>(values[0])
      : 1.0;
  }

  Numbers List(Tag tag) const { return EntryOr(this->Values, tag, {}); }
};

/** A TIFF file, whose entries are larger in BigTIFF. */
struct TiffFile
{
  BinaryFile File;
  bool IsWide = false;    ///< BigTIFF
  std::uint64_t Left = 0; ///< bytes of directories and values that may be read yet
  std::map<Part, std::uint64_t> Unpacked{}; ///< bytes that strips give, which pages may share

  int Wide(int narrow) const { return this->IsWide ? 2 * narrow : narrow; }

  /** The directory at this place. @throws Failure if it or its values go on behind the file. */
  Page ReadPage(std::uint64_t place)
  {
    const std::uint64_t count = this->File.Number(place, this->IsWide ? 8 : 2);
    const std::uint64_t first = place + (this->IsWide ? 8 : 2);
    const std::uint64_t entryBytes = this->IsWide ? 20 : 12;
    this->File.Need(first, Times(count, entryBytes));
    this->Take(count * entryBytes);
    Page page;
    const std::uint64_t end = first + count * entryBytes;
    page.Next = this->File.Number(end, this->Wide(4));
    page.Parts.push_back({ place, end + static_cast<std::uint64_t>(this->Wide(4)) });
    for (std::uint64_t entry = first; entry < end; entry += entryBytes)
    {
      this->ReadEntry(entry, page);
    }
    return page;
  }

private:
  /** Pages that share their values could have them read again and again. */
  void Take(std::uint64_t bytes)
  {
    FailIf(bytes > this->Left, "the file is damaged: its pages have more values than it has bytes");
    this->Left -= bytes;
  }

  void ReadEntry(std::uint64_t entry, Page& page)
  {
    static const std::uint64_t typeBytes[] = { 0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8,
      8 };
    const std::uint64_t tag = this->File.Number(entry, 2);
    const std::uint64_t type = this->File.Number(entry + 2, 2);
    const std::uint64_t bytes = type < std::size(typeBytes) ? typeBytes[type] : 0;
    const std::uint64_t size = Times(this->File.Number(entry + 4, this->Wide(4)), bytes);
    const bool isInside = size <= (this->IsWide ? 8u : 4u);
    const std::uint64_t place = entry + (this->IsWide ? 12 : 8);
    const std::uint64_t start = isInside ? place : this->File.Number(place, this->Wide(4));
    FailIf(!page.Values.emplace(tag, Numbers()).second,
      "its tag " + std::to_string(tag) + " is there twice");
    this->File.Need(start, size);
    if (!isInside)
    {
      page.Parts.push_back({ start, start + size });
    }
    if (tag == Description && type == 2)
    {
      this->Take(size);
      page.Words = this->File.Text(start, size);
    }
    else if ((tag == ResolutionX || tag == ResolutionY) && size == 8)
    {
      page.Values[tag] = { this->File.Number(start, 4), this->File.Number(start + 4, 4) };
    }
    else if (type == 3 || type == 4 || type == 13 || type == 16 || type == 18)
    {
      this->Take(size);
      const std::string text = this->File.Text(start, size);
      for (std::uint64_t at = 0; at < size; at += bytes)
      {
        page.Values[tag].push_back(NumberOf(text.substr(at, bytes), this->File.IsBig));
      }
    }
  }
};

/** @throws Failure unless vtkTIFFReader gives the values that are in the file. */
void CheckKind(const Page& page)
{
  for (const Tag tag : { Width, Height, Colours, Offsets, Sizes })
  {
    FailIf(!page.Has(tag),
      page.Has(TileWidth) ? "its pixels are in tiles; write it in strips"
                          : "it lacks the tag " + std::to_string(tag));
  }
  const std::uint64_t most = std::numeric_limits<int>::max();
  const std::uint64_t samples = page.Number(Samples, 1);
  const std::uint64_t pixels = Times(page.Number(Width, 0), page.Number(Height, 0));
  FailIf(pixels == 0 || Times(pixels, Times(4, samples)) > most,
    "it has " + std::to_string(page.Number(Width, 0)) + " x " +
      std::to_string(page.Number(Height, 0)) + " pixels");
  const std::uint64_t bits = page.Number(Bits, 1);
  const std::uint64_t packing = page.Number(Packing, 1);
  const std::uint64_t colours = page.Number(Colours, 0);
  const std::uint64_t format = page.Number(Format, 1);
  const bool isDecoded = packing == 1 || packing == 5 || packing == 8 || packing == 32773;
  const bool isGrey = colours <= 1 && samples == 1;
  const bool isColour = colours == 2 && (samples == 3 || samples == 4);
  const bool isMapped =
    colours == 3 && samples == 1 && bits <= 8 && page.List(ColourMap).size() == 3u << bits;
  // Of more than 8 bits only what is grey from black to white.
  const bool isWide = (bits == 16 || bits == 32) && isDecoded && isGrey && colours == 1;
  const bool isNarrow = bits == 8 && (isGrey || isColour || isMapped || colours > 3);
  const bool isSmall = (bits == 1 || bits == 2 || bits == 4) && samples == 1;
  FailIf((!isWide && !isNarrow && !isSmall) || page.Number(Planes, 1) > (samples == 1 ? 2 : 1) ||
      page.Number(Orientation, 1) - 1 >= 8 || format < 1 || format > (bits == 32 ? 3 : 2),
    "pixels of this kind are not read: " + std::to_string(samples) + " of " + std::to_string(bits) +
      " bits, format " + std::to_string(format) + ", colours " + std::to_string(colours) +
      ", packed by " + std::to_string(packing) +
      "; grey or coloured ones of 8 bits, and grey ones of 16 and 32 are");
}

/** Keep the places of the page's strips. @throws Failure if they are not those of its size. */
void CheckStrips(TiffFile& tiff, Page& page)
{
  const Numbers offsets = page.List(Offsets);
  const Numbers sizes = page.List(Sizes);
  const std::uint64_t height = page.Number(Height, 0);
  const std::uint64_t rows = std::min(page.Number(RowsPerStrip, height), height);
  const std::uint64_t strips = rows == 0 ? 0 : (height - 1) / rows + 1;
  FailIf(strips == 0 || offsets.size() != strips || sizes.size() != strips,
    "its strips have " + std::to_string(offsets.size()) + " places and " +
      std::to_string(sizes.size()) + " sizes, its rows ask for " + std::to_string(strips));
  const std::uint64_t rowBytes =
    (page.Number(Width, 0) * page.Number(Samples, 1) * page.Number(Bits, 1) + 7) / 8;
  const std::uint64_t packing = page.Number(Packing, 1);
  for (std::uint64_t i = 0; i < strips; ++i)
  {
    const std::uint64_t needed = rowBytes * std::min(rows, height - i * rows);
    tiff.File.Need(offsets[i], sizes[i]);
    const bool isPlain = packing == 1;
    FailIf(sizes[i] < (isPlain ? needed : 1),
      "a strip has " + std::to_string(sizes[i]) + " bytes, its rows ask for " +
        std::to_string(needed));
    if (packing == 8)
    {
      // Of the last strip some programs pack more rows than there are.
      const Part strip{ offsets[i], offsets[i] + sizes[i] };
      if (tiff.Unpacked.count(strip) == 0)
      {
        std::istringstream packed(tiff.File.Text(offsets[i], sizes[i]));
        tiff.Unpacked[strip] = Inflate(packed, Nowhere, Times(rowBytes, rows));
      }
      FailIf(
        tiff.Unpacked[strip] < needed, "a strip is packed from fewer bytes than its rows have");
    }
    page.Parts.push_back({ offsets[i], offsets[i] + (isPlain ? needed : sizes[i]) });
  }
}

/** @throws Failure unless the page is of the kind of the first one. */
void CheckLikeFirst(const Page& page, const Page& first)
{
  for (const Tag tag : { Kind, Width, Height, Bits, Packing, Colours, Orientation, Samples, Planes,
         Predictor, Format })
  {
    const auto textOf = [tag](const Page& any)
    { return any.Has(tag) ? std::to_string(any.Number(tag, 0)) : "none"; };
    FailIf(textOf(page) != textOf(first),
      "its tag " + std::to_string(tag) + " is " + textOf(page) + ", the first page's " +
        textOf(first) + "; pages of one kind are read");
  }
}

/** Whether a page that is not in the chain begins somewhere between two places. */
bool HoldsPage(TiffFile& tiff, const Part& gap, const std::vector<Part>& gaps)
{
  const std::string text = tiff.File.Text(gap.Begin, gap.End - gap.Begin);
  const std::size_t bytes = tiff.IsWide ? 8 : 2;
  for (std::size_t at = gap.Begin % 2; at + bytes + 2 <= text.size(); at += 2)
  {
    const std::uint64_t count = NumberOf(text.substr(at, bytes), tiff.File.IsBig);
    const std::uint64_t tag = NumberOf(text.substr(at + bytes, 2), tiff.File.IsBig);
    if (count < 4 || count > 200 || tag < Kind || tag > Width)
    {
      continue;
    }
    try
    {
      const Numbers offsets = tiff.ReadPage(gap.Begin + at).List(Offsets);
      // Programs that write a directory anew leave the old one, whose strips have another then.
      if (!offsets.empty() &&
        std::any_of(gaps.begin(), gaps.end(), [&](const Part& other)
          { return offsets[0] >= other.Begin && offsets[0] < other.End; }))
      {
        return true;
      }
    }
    catch (const Failure&)
    {
      // No page.
    }
  }
  return false;
}

/**
 * @throws Failure if parts overlap, or if as much as a page is in none of them.
 * @param page bytes of the largest page's strips
 */
void CheckParts(TiffFile& tiff, std::vector<Part> parts, std::uint64_t page)
{
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end()); // may be shared
  parts.push_back({ tiff.File.Size(), tiff.File.Size() });
  std::vector<Part> gaps;
  std::uint64_t unused = 0;
  std::uint64_t end = 0;
  for (const Part& part : parts)
  {
    FailIf(part.Begin < end,
      "the file is damaged: two parts of it overlap at byte " + std::to_string(part.Begin));
    if (part.Begin > end)
    {
      gaps.push_back({ end, part.Begin });
      unused += part.Begin - end;
    }
    end = part.End;
  }
  if (unused >= page ||
    std::any_of(
      gaps.begin(), gaps.end(), [&](const Part& gap) { return HoldsPage(tiff, gap, gaps); }))
  {
    throw Failure("the file is damaged, or no chain of pages: " + std::to_string(unused) +
      " bytes, among them pixels, are in none of its pages");
  }
}
}

int CheckTiff(const std::string& name, TiffFacts* facts)
{
  TiffFile tiff{ BinaryFile(name) };
  const std::string mark = tiff.File.Size() < 8 ? "" : tiff.File.Text(0, 2);
  tiff.File.IsBig = mark == "MM";
  const std::uint64_t version = mark == "II" || mark == "MM" ? tiff.File.Number(2, 2) : 0;
  if (version != 42 && version != 43)
  {
    return 0;
  }
  tiff.IsWide = version == 43;
  tiff.Left = 2 * tiff.File.Size();
  std::vector<Part> parts = { { 0, tiff.IsWide ? 16u : 8u } };
  std::uint64_t place = tiff.IsWide ? tiff.File.Number(8, 8) : tiff.File.Number(4, 4);
  std::set<std::uint64_t> places;
  Page first;
  TiffFacts found;
  std::uint64_t largest = 0;
  while (place != 0)
  {
    if (!places.insert(place).second || places.size() > std::numeric_limits<std::uint16_t>::max())
    {
      throw Failure("the file is damaged: its pages form a ring, or are more than libtiff counts");
    }
    try
    {
      Page page = tiff.ReadPage(place);
      CheckKind(page);
      if (places.size() == 1)
      {
        first = page;
        found = FactsOf(first.Words, first.Next == 0,
          { first.Distance(ResolutionX), first.Distance(ResolutionY), 1.0 });
      }
      CheckLikeFirst(page, first);
      const std::size_t directory = page.Parts.size();
      CheckStrips(tiff, page);
      std::uint64_t bytes = 0;
      for (std::size_t i = directory; i < page.Parts.size(); ++i)
      {
        bytes += page.Parts[i].End - page.Parts[i].Begin;
      }
      largest = std::max(largest, bytes);
      for (const Tag tag : { Inner, Exif, Gps })
      {
        for (const std::uint64_t inner : page.List(tag))
        {
          const std::vector<Part> own = tiff.ReadPage(inner).Parts;
          parts.insert(parts.end(), own.begin(), own.end());
        }
      }
      parts.insert(parts.end(), page.Parts.begin(), page.Parts.end());
      place = page.Next;
    }
    catch (const Failure& failure)
    {
      throw Failure("page " + std::to_string(places.size()) + ": " + failure.what());
    }
  }
  CheckParts(tiff, std::move(parts), largest);
  if (facts)
  {
    *facts = found;
  }
  return static_cast<int>(places.size());
}
}
