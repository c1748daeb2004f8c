// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// NIfTI-1, which Analyze 7.5 begins like, and NIfTI-2, which has wider numbers at other places.
#include "BinaryFile.h"
#include "ByteBudget.h"
#include "CheckInputs.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "Unpack.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace tool
{
namespace
{
/** NIfTI in two files: the one of these that is there, for the name of either. */
std::string NiftiPart(const std::string& name, const std::string& suffix)
{
  for (const char* end : { ".img.gz", ".hdr.gz", ".img", ".hdr" })
  {
    if (EndsWith(name, end))
    {
      const std::string part = name.substr(0, name.size() - std::strlen(end)) + suffix;
      return std::filesystem::exists(part) ? part : part + ".gz";
    }
  }
  return name;
}

/** Types of VTK's reader, numbers of 8 to 64 bits and colours, and their bits. */
std::uint64_t BitsOf(std::uint64_t type)
{
  static const std::map<std::uint64_t, std::uint64_t> bits = { { 2, 8 }, { 4, 16 }, { 8, 32 },
    { 16, 32 }, { 32, 64 }, { 64, 64 }, { 128, 24 }, { 256, 8 }, { 512, 16 }, { 768, 32 },
    { 1024, 64 }, { 1280, 64 }, { 1792, 128 }, { 2304, 32 } };
  const auto found = bits.find(type);
  if (found == bits.end())
  {
    throw Failure("its header is damaged: the data type " + std::to_string(type) +
      " is none of NIfTI's types of numbers");
  }
  return found->second;
}

/** The numbers of a header that say how many bytes of voxels there are, and where. */
class Header
{
public:
  explicit Header(const std::string& bytes) : Bytes(bytes)
  {
    if (bytes.size() >= 348)
    {
      const bool isBig = this->Number(0, 4) > 0xFFFF;
      this->IsBig = isBig;
      this->IsWide = this->Number(0, 4) == 540;
    }
    if (bytes.size() < (this->IsWide ? 540 : 348) || (!this->IsWide && this->Number(0, 4) != 348))
    {
      throw Failure("not a NIfTI or Analyze file, or its header is damaged or cut off");
    }
  }

  /** Whether it and the voxels are in one file, in two ("ni1"), or it is Analyze's (""). */
  std::string Mark() const { return this->Bytes.substr(this->IsWide ? 4 : 344, 3); }

  std::uint64_t Type() const { return this->Number(this->IsWide ? 12 : 70, 2); }
  std::uint64_t Bits() const { return this->Number(this->IsWide ? 14 : 72, 2); }

  /** How many dimensions there are (0), or the size of one of them. */
  std::uint64_t Size(std::size_t axis) const
  {
    return this->IsWide ? this->Number(16 + 8 * axis, 8) : this->Number(40 + 2 * axis, 2);
  }

  /** Where the voxels begin in their file. */
  std::uint64_t Start() const
  {
    if (this->IsWide)
    {
      return this->Number(168, 8);
    }
    const auto bits = static_cast<std::uint32_t>(this->Number(108, 4));
    float start = 0.0f;
    std::memcpy(&start, &bits, sizeof(start));
    if (!(start >= 0.0f && start < 1e9f) || start != std::floor(start))
    {
      throw Failure("its header is damaged: the voxels begin at byte " + std::to_string(start));
    }
    return static_cast<std::uint64_t>(start);
  }

  /** Bytes of a header before the voxels, with what tells of more of it. */
  std::uint64_t Length() const { return this->IsWide ? 544 : 352; }

private:
  std::uint64_t Number(std::size_t at, std::size_t bytes) const
  {
    return NumberOf(this->Bytes.substr(at, bytes), this->IsBig);
  }

  std::string Bytes;
  bool IsBig = false;
  bool IsWide = false;
};

/** Bytes of all voxels. @throws Failure for sizes that are none. */
std::uint64_t BytesOf(const Header& header)
{
  const std::uint64_t bits = BitsOf(header.Type());
  if (header.Bits() != bits)
  {
    throw Failure("its header is damaged: voxels of type " + std::to_string(header.Type()) +
      " have " + std::to_string(bits) + " bits, not " + std::to_string(header.Bits()));
  }
  const std::uint64_t axes = header.Size(0);
  if (axes < 1 || axes > 7)
  {
    throw Failure("its header is damaged: " + std::to_string(axes) + " dimensions");
  }
  std::uint64_t bytes = bits / 8;
  for (std::size_t axis = 1; axis <= axes; ++axis)
  {
    const std::uint64_t size = header.Size(axis);
    // Those behind the sixth are passed over by VTK's reader.
    if (size < 1 || size > (axis < 6 ? 0x7FFFFFFFu : 1u))
    {
      throw Failure("its header is damaged, or it is no volume: the size of dimension " +
        std::to_string(axis) + " is " + std::to_string(size));
    }
    bytes = Times(bytes, size);
  }
  return bytes;
}

/**
 * The bytes that a file unpacks to, if it is packed, or has.
 * @throws Failure if it is damaged, or as soon as it gives more than `most`.
 */
std::uint64_t BytesWithin(const std::string& name, std::uint64_t most)
{
  std::ifstream packed(name, std::ios::binary);
  return IsGzip(name) ? Inflate(packed, Nowhere, most) : BinaryFile(name).Size();
}
}

std::uint64_t CheckNifti(const std::string& name)
{
  const std::string headerFile = NiftiPart(name, ".hdr");
  const std::string dataFile = NiftiPart(name, ".img");
  const Header header(HeadOf(headerFile, 540));
  const bool isOne = dataFile == headerFile;
  const std::string mark = header.Mark();
  if (isOne && mark != "n+1" && mark != "n+2")
  {
    throw Failure("not a NIfTI file, or its header is damaged: its mark is not n+1 or n+2");
  }
  const std::uint64_t needed = BytesOf(header);
  const std::uint64_t start = header.Start();
  if (isOne && start < header.Length())
  {
    throw Failure("its header is damaged: the voxels begin at byte " + std::to_string(start) +
      ", which is within the header");
  }
  if (!isOne)
  {
    BytesWithin(headerFile, LargestHeader);
  }
  const bool isPacked = IsGzip(dataFile);
  const std::uint64_t there = BytesWithin(dataFile, isPacked ? MostUnpacked(needed, start) : 0);
  NeedJustBytes(there - std::min(there, start), needed);
  return there;
}
}
