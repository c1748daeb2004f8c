// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBinaryFile_h
#define volumicBinaryFile_h

#include <array>
#include <cstdint>
#include <fstream>
#include <string>

namespace tool
{
/** @throws Failure that names it, for a pipe or a device, which may have no end. */
void NeedFile(const std::string& name);

/** A file of binary numbers, read at any place. */
class BinaryFile
{
public:
  /** @throws Failure if it cannot be opened, or as NeedFile. */
  explicit BinaryFile(const std::string& name);

  bool IsBig = false; ///< whether numbers have their most significant byte first

  std::uint64_t Size() const { return this->Bytes; }

  /** @throws Failure unless so many bytes are at a place. */
  void Need(std::uint64_t at, std::uint64_t count) const;

  /** The text of so many bytes at a place. @throws as Need. */
  std::string Text(std::uint64_t at, std::uint64_t count);

  /** The unsigned number of 1 to 8 bytes at a place. @throws as Text. */
  std::uint64_t Number(std::uint64_t at, int bytes);

  /** The same of 2 or 4 bytes with a sign. */
  std::int64_t Signed(std::uint64_t at, int bytes);

private:
  std::ifstream File;
  std::uint64_t Bytes = 0;
};

/** The unsigned number that these bytes are. */
std::uint64_t NumberOf(const std::string& bytes, bool isBig);

// ---- How many bytes a file may ask for ----------------------------------------------------------

// How many bytes a file may ask for. Whoever made it may have meant harm, so no reader multiplies
// sizes, takes memory or unpacks by what a header says without asking here.

/** The most bytes of a header that is text; of lists of names; of what comes before packed voxels. */
constexpr std::uint64_t LargestText = 1 << 20;
constexpr std::uint64_t LargestNames = 16 << 20;
constexpr std::uint64_t LargestHeader = 64 << 20;

/** The product, or the largest number where that would be more: sizes of damaged headers. */
std::uint64_t Times(std::uint64_t a, std::uint64_t b);

/** Bytes of all voxels, of values whose type is as VTK numbers types; saturated as Times. */
std::uint64_t BytesOfVoxels(int type, int components, const std::array<int, 3>& size);

/**
 * How many bytes packed data may give: so many voxels, behind so many bytes of a header and what
 * comes with it. @throws Failure if these are more than any header has.
 */
std::uint64_t MostUnpacked(std::uint64_t voxels, std::uint64_t before);

/** How many bytes one packed byte gives at most. */
constexpr std::uint64_t MostOfZlib = 1100;
constexpr std::uint64_t MostOfBzip2 = 2000000;

/** @throws Failure if packed bytes, each of which gives so many at most, are fewer than needed. */
void NeedPackedBytes(std::uint64_t there, std::uint64_t most, std::uint64_t needed);

/** @throws Failure if there are fewer bytes than needed. */
void NeedBytes(std::uint64_t there, std::uint64_t needed);

/**
 * The same, and if there are more: bytes that are one too many among or before the voxels move all
 * that follow.
 */
void NeedJustBytes(std::uint64_t there, std::uint64_t needed);
}

#endif
