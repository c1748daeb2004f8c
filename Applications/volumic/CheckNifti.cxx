// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "BinaryFile.h"
#include "ByteBudget.h"
#include "CheckInputs.h"
#include "NiftiHeader.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "Unpack.h"

#include <algorithm>
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

/** Bytes of all voxels. @throws Failure for sizes that are none. */
std::uint64_t BytesOf(const NiftiHeader& header)
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
  const NiftiHeader header(HeadOf(headerFile, 540));
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
