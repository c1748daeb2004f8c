// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// PNG (W3C recommendation), BMP, PGM and PPM (Netpbm), TGA (Truevision).
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkObject.h>
#include <vtk_zlib.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace tool
{
namespace
{
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
    FailIf(sum != file.Number(at + 8 + length, 4),
      "the file is damaged: the checksum of its part at byte " + std::to_string(at) +
        " is wrong; copy it again");
    kind = chunk.substr(0, 4);
    at += 12 + length;
  }
}

/** The rows, each of a multiple of four bytes, behind two headers. */
void CheckBmp(const std::string& name)
{
  BinaryFile file(name);
  if (file.Size() < 34 || file.Text(0, 2) != "BM")
  {
    return;
  }
  const std::uint64_t bits = file.Number(28, 2);
  FailIf((bits != 8 && bits != 24) || file.Number(30, 4) != 0,
    std::to_string(bits) + " bits for a pixel, packed by " + std::to_string(file.Number(30, 4)) +
      "; 8 and 24 that are not packed are read");
  const auto width = static_cast<std::uint64_t>(std::max<std::int64_t>(file.Signed(18, 4), 0));
  const auto rows = static_cast<std::uint64_t>(std::abs(file.Signed(22, 4)));
  const std::uint64_t start = file.Number(10, 4);
  NeedJustBytes(file.Size(), file.Number(2, 4));
  // Some programs fill the file up.
  const std::uint64_t needed = Times((width * bits + 31) / 32 * 4, rows);
  file.Need(start, needed);
  FailIf(needed == 0 || start < 14 + file.Number(14, 4) || file.Size() - start - needed > 3,
    "its header is damaged: " + std::to_string(width) + " x " + std::to_string(rows) +
      " pixels from byte " + std::to_string(start));
}

/** PGM and PPM: a head of words, one blank and the pixels; VTK's reader takes the last bytes. */
void CheckPnm(const std::string& name)
{
  BinaryFile file(name);
  const std::string head = file.Text(0, std::min<std::uint64_t>(file.Size(), 1 << 16));
  if (head.compare(0, 2, "P5") != 0 && head.compare(0, 2, "P6") != 0)
  {
    return;
  }
  std::uint64_t numbers[3] = { 0, 0, 0 };
  std::size_t at = 2;
  for (std::uint64_t& number : numbers)
  {
    at = head.find_first_not_of(" \t\r\n", at);
    while (at != std::string::npos && head[at] == '#')
    {
      at = head.find_first_not_of(" \t\r\n", head.find('\n', at));
    }
    const std::size_t end = head.find_first_not_of("0123456789", std::min(at, head.size()));
    FailIf(at == std::string::npos || end == at || end == std::string::npos || end - at > 9,
      "its header is damaged, or it is no picture");
    number = std::stoull(head.substr(at, end - at));
    at = end;
  }
  const std::uint64_t bytes = (head[1] == '5' ? 1 : 3) * (numbers[2] > 255 ? 2 : 1);
  FailIf(numbers[0] < 1 || numbers[1] < 1 || numbers[2] < 1 || numbers[2] > 65535 ||
      std::string(" \t\r\n").find(head[at]) == std::string::npos,
    "its header is damaged, or it is no picture");
  NeedJustBytes(file.Size() - at - 1, Times(Times(numbers[0], numbers[1]), bytes));
}

/** A header of 18 bytes, then pixels, or packets of them. */
void CheckTga(const std::string& name)
{
  BinaryFile file(name);
  const std::string head = file.Text(0, 18);
  const std::uint64_t bytes = NumberOf(head.substr(16, 1), false) / 8;
  const std::uint64_t width = NumberOf(head.substr(12, 2), false);
  const std::uint64_t rows = NumberOf(head.substr(14, 2), false);
  const std::uint64_t most = std::numeric_limits<std::int16_t>::max();
  FailIf((bytes != 3 && bytes != 4) || width < 1 || rows < 1 || width > most || rows > most ||
      head[0] != 0 || (head[2] != 2 && head[2] != 10),
    "its header is damaged, or it is no picture");
  std::uint64_t left = width * rows;
  std::uint64_t at = head.size();
  if (head[2] == 2)
  {
    file.Need(at, left * bytes);
    return;
  }
  // Packets: a pixel that is repeated, or so many pixels.
  const std::string packed = file.Text(0, file.Size());
  while (left > 0)
  {
    const std::uint64_t packet =
      at < packed.size() ? static_cast<unsigned char>(packed[at]) : std::uint64_t(0);
    const std::uint64_t count = packet % 128 + 1;
    at += 1 + bytes * (packet < 128 ? count : 1);
    FailIf(count > left || at > packed.size(),
      "the file is cut off or damaged: its packed pixels are not as many as its rows "
      "ask for");
    left -= count;
  }
}
}

void CheckChosen(vtkObject* reader, const std::string& name)
{
  if (reader->IsA("vtkTGAReader"))
  {
    CheckTga(name);
  }
  const std::string mark = BinaryFile(name).Text(0, 2);
  FailIf(
    reader->IsA("vtkHDRReader") || (reader->IsA("vtkPNMReader") && mark != "P5" && mark != "P6"),
    "pictures of this kind are not read; PNG, TIFF, JPEG, BMP, PGM and PPM are");
}

void CheckPixels(const std::string& name)
{
  CheckPng(name);
  CheckBmp(name);
  CheckPnm(name);
}

// ---- netCDF -------------------------------------------------------------------------------------

// The classic form (its specification: NetCDF Classic Format, in netCDF's documentation).
namespace
{
/** Bytes of a value of this type. */
std::uint64_t TypeBytes(std::uint64_t type)
{
  static const std::uint64_t sizes[] = { 0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8 };
  FailIf(
    type == 0 || type >= 12, "its header is damaged: there is no type " + std::to_string(type));
  return sizes[type];
}

/** Reads the header from its start to its end. */
class Header
{
public:
  explicit Header(const std::string& name) : File(name)
  {
    this->File.IsBig = true;
    const std::string mark = this->File.Size() < 4 ? "" : this->File.Text(0, 4);
    this->Version = mark.compare(0, 3, "CDF") == 0 ? mark[3] : 0;
    this->At = 4;
  }

  int Version; ///< 1, 2 or 5; others are another format

  std::uint64_t Next(int bytes)
  {
    this->At += static_cast<std::uint64_t>(bytes);
    return this->File.Number(this->At - static_cast<std::uint64_t>(bytes), bytes);
  }
  std::uint64_t Count() { return this->Next(this->Version == 5 ? 8 : 4); }
  std::uint64_t Place() { return this->Next(this->Version == 1 ? 4 : 8); }

  /** Go on by so many bytes, in units of four. */
  void Skip(std::uint64_t bytes)
  {
    FailIf(bytes > this->File.Size(), "the file is cut off within its header, or that is damaged");
    this->At += (bytes + 3) / 4 * 4;
  }
  void SkipName() { this->Skip(this->Count()); }

  /** How many there are in the list that begins here. */
  std::uint64_t ListCount()
  {
    this->Next(4);
    return this->Count();
  }

  void SkipAttributes()
  {
    for (std::uint64_t left = this->ListCount(); left > 0; --left)
    {
      this->SkipName();
      const std::uint64_t bytes = TypeBytes(this->Next(4));
      this->Skip(Times(this->Count(), bytes));
    }
  }

  /**
   * @return whether the variable that begins here is the image.
   * @throws Failure if its data go on behind the file, or VTK's reader has no room for it.
   */
  bool CheckVariable(const std::vector<std::uint64_t>& sizes)
  {
    const std::uint64_t length = this->Count();
    const bool isImage = length == 5 && this->File.Text(this->At, length) == "image";
    this->Skip(length);
    std::uint64_t values = 1;
    const std::uint64_t dimensions = this->Count();
    for (std::uint64_t left = dimensions; left > 0; --left)
    {
      const std::uint64_t dimension = this->Count();
      values = Times(values, dimension < sizes.size() ? sizes[dimension] : 0);
    }
    const std::uint64_t most = 8;
    FailIf(dimensions > most || (isImage && (dimensions < 2 || values == 0)),
      "its header is damaged, or it is no volume: a variable has " + std::to_string(dimensions) +
        " dimensions and " + std::to_string(values) + " values");
    this->SkipAttributes();
    const std::uint64_t needed = Times(values, TypeBytes(this->Next(4)));
    this->Count(); // of bytes, which is too small a number for large variables
    const std::uint64_t start = this->Place();
    NeedBytes(this->File.Size() - std::min(this->File.Size(), start), needed);
    return isImage;
  }

private:
  BinaryFile File;
  std::uint64_t At = 0;
};
}

void CheckNetcdf(const std::string& name)
{
  Header header(name);
  if (header.Version != 1 && header.Version != 2 && header.Version != 5)
  {
    return;
  }
  header.Count(); // of records, whose dimension has the size 0
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t left = header.ListCount(); left > 0; --left)
  {
    header.SkipName();
    sizes.push_back(header.Count());
  }
  header.SkipAttributes();
  bool hasImage = false;
  for (std::uint64_t left = header.ListCount(); left > 0; --left)
  {
    const bool isImage = header.CheckVariable(sizes);
    hasImage = hasImage || isImage;
  }
  FailIf(!hasImage, "it has no image: no MINC file, or damaged");
}
}
