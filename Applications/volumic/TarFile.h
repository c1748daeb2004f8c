// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTarFile_h
#define volumicTarFile_h

#include <cstdint>
#include <string>

namespace tool
{
/**
 * The members of a tar archive, packed by gzip or not, one after the other. Nothing is unpacked to
 * disk. Failures are without the name of the file.
 */
class TarFile
{
public:
  /** @throws Failure if it cannot be opened. */
  explicit TarFile(const std::string& name);
  ~TarFile();
  TarFile(const TarFile&) = delete;
  TarFile& operator=(const TarFile&) = delete;

  /**
   * Go to the next regular file. @return false at the end of the archive.
   * @throws Failure if the archive is damaged or cut off.
   */
  bool Next();

  const std::string& Name() const { return this->MemberName; } ///< without folders
  std::uint64_t Size() const { return this->MemberSize; }

  /** The member's bytes, Size() of them, once. @throws as Next. */
  void Read(char* bytes);

  /** Read the file to its end, where the checksum of packed data stands. @throws as Next. */
  void Finish();

private:
  std::uint64_t ReadSome(char* bytes, std::uint64_t count);
  void ReadAll(char* bytes, std::uint64_t count);
  void Skip(std::uint64_t count);
  std::string ReadText();

  void* File; ///< gzFile
  std::string MemberName;
  std::uint64_t MemberSize = 0;
  std::uint64_t Unread = 0; ///< of the member, what fills its last block included
};
}

#endif
