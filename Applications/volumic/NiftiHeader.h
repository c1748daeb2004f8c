// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicNiftiHeader_h
#define volumicNiftiHeader_h

#include "BinaryFile.h"
#include "ToolErrors.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace tool
{
/**
 * The numbers of a header that say how many bytes of voxels there are, and where: of NIfTI-1, which
 * Analyze 7.5 begins like, or of NIfTI-2, which has wider numbers at other places.
 */
class NiftiHeader
{
public:
  /** @param bytes the first 540 of the file. @throws Failure if they are no such header. */
  explicit NiftiHeader(const std::string& bytes) : Bytes(bytes)
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
}

#endif
