// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// TIFF 6.0, and BigTIFF, which has wider numbers; PNG (W3C recommendation).
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ToolErrors.h"

#include <vtk_zlib.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace tool
{
namespace
{
/** Bytes of a number in a TIFF entry of this type, as far as offsets and sizes have it. */
int TiffTypeBytes(std::uint64_t type)
{
  return type == 3 ? 2 : type == 4 ? 4 : type == 16 ? 8 : 0;
}

/** A TIFF file, whose entries are larger in BigTIFF. */
struct TiffFile
{
  BinaryFile File;
  bool IsWide = false; ///< BigTIFF

  int Wide(int narrow) const { return this->IsWide ? 2 * narrow : narrow; }

  /** The numbers of the entry at this place. */
  std::vector<std::uint64_t> Values(std::uint64_t entry)
  {
    const int bytes = TiffTypeBytes(this->File.Number(entry + 2, 2));
    const std::uint64_t count = this->File.Number(entry + 4, this->Wide(4));
    const std::uint64_t place = entry + (this->IsWide ? 12 : 8);
    const std::uint64_t size = Times(count, static_cast<std::uint64_t>(bytes));
    const std::uint64_t start =
      size <= (this->IsWide ? 8u : 4u) ? place : this->File.Number(place, this->Wide(4));
    const std::string text = this->File.Text(start, size);
    std::vector<std::uint64_t> values;
    for (std::uint64_t at = 0; bytes > 0 && at < size; at += static_cast<std::uint64_t>(bytes))
    {
      values.push_back(
        NumberOf(text.substr(at, static_cast<std::size_t>(bytes)), this->File.IsBig));
    }
    return values;
  }
};

/** Look whether the page's strips or tiles lie within the file; returns where the next page is. */
std::uint64_t CheckPage(TiffFile& tiff, std::uint64_t page)
{
  const std::uint64_t entryBytes = tiff.IsWide ? 20 : 12;
  const std::uint64_t count = tiff.File.Number(page, tiff.IsWide ? 8 : 2);
  const std::uint64_t first = page + (tiff.IsWide ? 8 : 2);
  std::map<std::uint64_t, std::vector<std::uint64_t>> places;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::uint64_t entry = first + i * entryBytes;
    const std::uint64_t tag = tiff.File.Number(entry, 2);
    // The offsets and the sizes of strips and of tiles.
    if (tag == 273 || tag == 279 || tag == 324 || tag == 325)
    {
      places[tag] = tiff.Values(entry);
    }
  }
  for (const auto& [offsets, sizes] :
    { std::pair{ places[273], places[279] }, std::pair{ places[324], places[325] } })
  {
    for (std::size_t i = 0; i < std::min(offsets.size(), sizes.size()); ++i)
    {
      const std::uint64_t size = tiff.File.Size();
      if (offsets[i] > size || sizes[i] > size - offsets[i])
      {
        throw Failure("the file is cut off: it has " + std::to_string(size) +
          " bytes, the data of a page go on to " + std::to_string(offsets[i] + sizes[i]) +
          "; copy it again");
      }
    }
  }
  return tiff.File.Number(first + count * entryBytes, tiff.Wide(4));
}

void CheckTiff(const std::string& name)
{
  TiffFile tiff{ BinaryFile(name) };
  const std::string mark = tiff.File.Size() < 8 ? "" : tiff.File.Text(0, 2);
  tiff.File.IsBig = mark == "MM";
  const std::uint64_t version = mark == "II" || mark == "MM" ? tiff.File.Number(2, 2) : 0;
  if (version != 42 && version != 43)
  {
    return;
  }
  tiff.IsWide = version == 43;
  std::uint64_t page = tiff.IsWide ? tiff.File.Number(8, 8) : tiff.File.Number(4, 4);
  std::set<std::uint64_t> pages;
  while (page != 0)
  {
    if (!pages.insert(page).second)
    {
      throw Failure("the file is damaged: its pages form a ring");
    }
    page = CheckPage(tiff, page);
  }
}

/** A chain of chunks, each with its checksum. */
void CheckPng(const std::string& name)
{
  BinaryFile file(name);
  file.IsBig = true;
  const std::string mark = "\x89PNG\r\n\x1a\n";
  if (file.Size() < mark.size() || file.Text(0, mark.size()) != mark)
  {
    return;
  }
  std::string kind;
  for (std::uint64_t at = mark.size(); kind != "IEND";)
  {
    const std::uint64_t length = file.Number(at, 4);
    const std::string chunk = file.Text(at + 4, length + 4);
    const uLong sum = crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(chunk.data()),
      static_cast<uInt>(chunk.size()));
    if (sum != file.Number(at + 8 + length, 4))
    {
      throw Failure("the file is damaged: the checksum of its part at byte " + std::to_string(at) +
        " is wrong; copy it again");
    }
    kind = chunk.substr(0, 4);
    at += 12 + length;
  }
}
}

void CheckPicture(const std::string& name)
{
  CheckTiff(name);
  CheckPng(name);
}
}
