// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRawSlabs_h
#define volumicRawSlabs_h

#include "SlabReader.h"

#include <cstdint>
#include <fstream>
#include <string>

namespace tool
{
/** A file without a name in a folder: it is there as long as this object or the process. */
class NamelessFile
{
public:
  /** @param directory empty: TMPDIR, or /var/tmp. @throws Failure if there can be none. */
  explicit NamelessFile(const std::string& directory);
  ~NamelessFile();
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  /** @throws Failure if the disk is full. */
  void Append(const char* bytes, std::size_t count);

  /** By which it can be opened, in this process. */
  std::string Path() const;

private:
  std::string Directory;
  int Descriptor = -1;
};

/**
 * What a file holds packed by zlib or gzip, behind its first `start` bytes.
 * @param count of bytes that it must give; no more are written
 * @throws Failure if it is damaged, cut off or of another size.
 */
std::unique_ptr<NamelessFile> Unpack(const std::string& name, std::uint64_t start,
  const std::string& directory, std::uint64_t count);

/** The bytes of a data file. @throws Failure that names it if it cannot be opened. */
std::uint64_t SizeOfData(const std::string& name);

/** Values as they lie in a file, x fastest. */
class RawSlabs : public SlabReader
{
public:
  std::string File;
  std::uint64_t Start = 0; ///< bytes before the first value
  bool IsBig = false;      ///< the most significant byte first
  std::unique_ptr<NamelessFile> Unpacked; ///< which File is, or null

  vtkSmartPointer<vtkDataArray> Read(int first, int count) override;

  /** Bytes of all values. */
  std::uint64_t Bytes() const;

private:
  std::ifstream Stream;
};
}

#endif
