// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRawSlabs_h
#define volumicRawSlabs_h

#include "BinaryFile.h"
#include "Descriptor.h"
#include "SlabReader.h"

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace tool
{
/** A file without a name in a folder: it is there as long as this object or the process. */
class NamelessFile
{
public:
  /** @param directory empty: TMPDIR, or /var/tmp. @throws Failure if there can be none. */
  explicit NamelessFile(const std::string& directory);

  /** @throws Failure if the disk is full. */
  void Append(const char* bytes, std::size_t count);

  /** By which it can be opened, in this process. */
  const std::string& Path() const { return this->Link; }

private:
  NamelessFile(const std::string& directory, int number);

  std::string Directory;
  std::string Link;
  Descriptor File;
};

/** The stream of a data file, at that byte. @throws Failure that names it if it cannot be opened. */
std::ifstream OpenData(const std::string& name, std::uint64_t start);

/** Values one behind the other in a file, or in several, an equal share in each, x fastest. */
class RawSlabs : public SlabReader
{
public:
  enum class Packing
  {
    None,
    Zlib, ///< or gzip
    Bzip2,
    Text ///< numbers with blanks between
  };

  std::vector<std::string> Files;
  Packing Code = Packing::None;
  std::uint64_t Start = 0;  ///< Each file has so many bytes before its values, packed or not.
  std::uint64_t Before = 0; ///< What is packed begins with so many bytes before the values.
  bool AreLast = false;     ///< The values are the last bytes of a file, whatever is before.
  bool IsBig = false;       ///< The most significant byte of a value comes first.

  /**
   * To call when all this is known. Packed values, of which parts will be wanted, are unpacked.
   * @throws Failure, before memory is taken, if a file is too short or too long.
   */
  void Prepare(const Opening& opening);

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

private:
  /** Bytes of all values, and of those in each file. */
  std::uint64_t Bytes() const;
  std::uint64_t Share() const { return this->Bytes() / this->Files.size(); }

  void CheckLength(const std::string& file) const;
  std::uint64_t StartIn(const std::string& file) const;
  void Unpack(const UnpackedSink& sink) const;
  void ReadBytes(std::uint64_t first, std::uint64_t count, char* values) const;

  std::unique_ptr<NamelessFile> Unpacked; ///< If it is there, it is the only one of Files.
};
}

#endif
