// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicArchive_h
#define volumicArchive_h

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

struct archive;

namespace tool
{
/** What libarchive reads. Nothing is unpacked to disk. Failures are without the name of the file. */
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
};
}

#endif
