// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBinaryFile_h
#define volumicBinaryFile_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <vector>

struct archive;

namespace tool
{
/** @throws Failure that names it, for what must not be read, or a pipe or device: without end. */
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

/** The most bytes of a header that is text; of lists of names; of what comes before packed voxels.
 */
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

// ---- Packed data --------------------------------------------------------------------------------

/** Takes unpacked bytes, in their order. */
using UnpackedSink = std::function<void(const char* bytes, std::size_t count)>;

/** Lets them go: only the checksum is wanted. */
inline const UnpackedSink Nowhere = [](const char*, std::size_t) {};

/** Hands them on without so many at the begin. */
UnpackedSink Without(std::uint64_t before, const UnpackedSink& sink);

/**
 * Unpack zlib or gzip data to their end, which alone tells whether they are what was packed: the
 * checksum stands there. Several members, one behind the other, are one file.
 * @return how many bytes there were
 * @throws Failure, without a name, if they are damaged or cut off, or as soon as they give more.
 */
std::uint64_t Inflate(std::istream& packed, const UnpackedSink& sink, std::uint64_t most);

/** The same of data that must give just so many bytes. @throws Failure if they don't. */
void InflateJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count);

/** Likewise of bzip2. */
void BunzipJust(std::istream& packed, const UnpackedSink& sink, std::uint64_t count);

/** Whether a file begins as those of gzip do. */
bool IsGzip(const std::string& name);

/**
 * The first bytes that a gzip file unpacks to, or those of a file that is not packed; `count` at
 * most. What follows them is not looked at.
 */
std::string HeadOf(const std::string& name, std::size_t count);

// ---- Archives -----------------------------------------------------------------------------------

/** What libarchive reads. Nothing is unpacked to disk. Failures are without the name of the file.
 */
class Archive
{
public:
  /** Gives the next bytes, as many as asked for if there are so many; -1: they are damaged. */
  using Source = std::function<std::int64_t(char* bytes, std::size_t count)>;

  enum class Kind
  {
    Tar,
    Bzip2 ///< with one member, which has no name
  };

  /** @throws Failure if it is of another kind, or damaged where it begins. */
  Archive(Kind kind, Source source);
  Archive(const Archive&) = delete; // libarchive knows where it is
  Archive& operator=(const Archive&) = delete;

  /** A tar archive in a file, packed by gzip or not. @throws Failure if it cannot be opened. */
  static Source TarIn(const std::string& name);

  /** Go to the next regular file. @return false at the end. @throws Failure if it is damaged. */
  bool Next();

  const std::string& Name() const { return this->MemberName; } ///< without folders
  std::uint64_t Size() const { return this->MemberSize; }      ///< as a head tells

  /** The next bytes of the member. @return how many there were. @throws as Next. */
  std::size_t Read(char* bytes, std::size_t count);

  /** Read what there is to its end, where the checksum of packed data stands. @throws as Next. */
  void Finish();

private:
  /** @throws Failure with libarchive's reason if a call of it has failed. */
  std::int64_t Need(std::int64_t result) const;

  Source Packed;
  std::vector<char> Piece;
  std::unique_ptr<archive, int (*)(archive*)> Reader;
  std::string MemberName;
  std::uint64_t MemberSize = 0;
  std::uint64_t MemberDone = 0; ///< bytes of it that have been read
  const char* Block = nullptr;  ///< the next ones,
  std::size_t BlockLeft = 0;    ///< so many
};
}

#endif
