// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The classic netCDF format (its specification: NetCDF Classic Format, in netCDF's documentation).
#include "BinaryFile.h"
#include "CheckInputs.h"
#include "ToolErrors.h"

#include <algorithm>
#include <vector>

namespace tool
{
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
