// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBinaryFile_h
#define volumicBinaryFile_h

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
}

#endif
