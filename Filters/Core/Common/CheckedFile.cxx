// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/CheckedFile.h"

#include "Core/Common/ContentHash.h"
#include "Core/Common/Join.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#ifdef _WIN32
#include <io.h>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace volumic
{
namespace
{
// A file is a row of buffers: their head, then so many bytes. The last one has none.
constexpr std::size_t BufferSize = 1 << 20;

struct BufferHead
{
  std::uint64_t Count;
  std::uint64_t Hash; ///< Of all buffers up to this one: none is missing, or of another file.
};

std::string ReasonOf(int error)
{
  return error != 0 ? std::generic_category().message(error) : "unknown reason";
}

std::string Unfinished(const std::string& name)
{
  return name + ".new";
}

/** Whether the disk has the file. Some network folders know no such request. */
bool Flush(std::FILE* file)
{
#ifdef _WIN32
  return std::fflush(file) == 0 && _commit(_fileno(file)) == 0;
#else
  return std::fflush(file) == 0 &&
    (fsync(fileno(file)) == 0 || errno == EINVAL || errno == ENOTSUP);
#endif
}

/** A new file; a link in its place is not followed. */
std::FILE* Create(const std::string& name)
{
  std::remove(name.c_str());
#ifdef _WIN32
  return std::fopen(name.c_str(), "wb");
#else
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  return file >= 0 ? fdopen(file, "wb") : nullptr;
#endif
}

/** A file of this user's, or null: others may have put theirs, a link or a pipe in its place. */
std::FILE* Open(const std::string& name)
{
#ifdef _WIN32
  return std::fopen(name.c_str(), "rb");
#else
  const int file = open(name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  struct stat facts
  {
  };
  if (file < 0 || fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode) ||
    facts.st_uid != geteuid())
  {
    const int reason = file < 0 ? errno : EPERM;
    close(file);
    errno = reason;
    return nullptr;
  }
  return fdopen(file, "rb");
#endif
}
}

CheckedWriter::CheckedWriter(const std::string& name)
  : Name(name), File(Create(Unfinished(name)))
{
  if (!this->File)
  {
    this->Fail();
  }
  std::setvbuf(this->File, nullptr, _IONBF, 0); // Buffers are large.
  this->Buffer.reserve(BufferSize);
}

CheckedWriter::~CheckedWriter()
{
  if (this->File)
  {
    std::fclose(this->File);
    std::remove(Unfinished(this->Name).c_str());
  }
}

void CheckedWriter::Fail()
{
  const int error = errno;
  throw FileError(Join(this->Name, " cannot be written (", ReasonOf(error), ")"));
}

void CheckedWriter::WriteBuffer()
{
  const std::size_t count = this->Buffer.size();
  this->Hash =
    CombineHashes(this->Hash, CombineHashes(count, ContentHash(this->Buffer.data(), count)));
  const BufferHead head = { count, this->Hash };
  errno = 0;
  if (std::fwrite(&head, 1, sizeof(head), this->File) != sizeof(head) ||
    std::fwrite(this->Buffer.data(), 1, count, this->File) != count)
  {
    this->Fail();
  }
  this->Buffer.clear();
}

void CheckedWriter::Write(const void* bytes, std::size_t count)
{
  const auto* next = static_cast<const unsigned char*>(bytes);
  while (count > 0)
  {
    const std::size_t part = std::min(count, BufferSize - this->Buffer.size());
    this->Buffer.insert(this->Buffer.end(), next, next + part);
    next += part;
    count -= part;
    if (this->Buffer.size() == BufferSize)
    {
      this->WriteBuffer();
    }
  }
}

void CheckedWriter::PutText(const std::string& text)
{
  this->Put<std::uint64_t>(text.size());
  this->Write(text.data(), text.size());
}

void CheckedWriter::Commit()
{
  if (!this->Buffer.empty())
  {
    this->WriteBuffer();
  }
  this->WriteBuffer(); // The end.
  errno = 0;
  if (!Flush(this->File))
  {
    this->Fail();
  }
  std::FILE* file = this->File;
  this->File = nullptr;
  std::error_code failed;
  if (std::fclose(file) == 0)
  {
    std::filesystem::rename(Unfinished(this->Name), this->Name, failed);
  }
  else
  {
    failed = std::error_code(errno, std::generic_category());
  }
  if (failed)
  {
    std::remove(Unfinished(this->Name).c_str());
    throw FileError(Join(this->Name, " cannot be written (", failed.message(), ")"));
  }
  FlushFolder(std::filesystem::path(this->Name).parent_path().string());
}

CheckedReader::CheckedReader(const std::string& name)
  : Name(name), File(Open(name))
{
  if (!this->File)
  {
    this->Refuse(
      errno == EPERM ? "is no file of yours" : Join("cannot be read (", ReasonOf(errno), ")"));
  }
  std::fseek(this->File, 0, SEEK_END);
  this->Left = static_cast<std::uint64_t>(std::ftell(this->File));
  std::rewind(this->File);
  std::setvbuf(this->File, nullptr, _IONBF, 0);
}

CheckedReader::~CheckedReader()
{
  if (this->File)
  {
    std::fclose(this->File);
  }
}

void CheckedReader::Refuse(const std::string& reason) const
{
  throw FileError(Join(this->Name, " ", reason));
}

bool CheckedReader::Fetch(void* bytes, std::size_t count)
{
  const std::uint64_t left = this->Left;
  this->Left -= std::min<std::uint64_t>(left, count);
  return std::fread(bytes, 1, count, this->File) == count;
}

void CheckedReader::ReadBuffer()
{
  BufferHead head;
  if (!this->Fetch(&head, sizeof(head)) || head.Count > BufferSize)
  {
    this->Refuse("is damaged");
  }
  this->Buffer.resize(head.Count);
  this->Taken = 0;
  const bool isWhole = this->Fetch(this->Buffer.data(), head.Count);
  this->Hash = CombineHashes(
    this->Hash, CombineHashes(head.Count, ContentHash(this->Buffer.data(), head.Count)));
  if (!isWhole || this->Hash != head.Hash || head.Count == 0)
  {
    this->Refuse("is damaged");
  }
}

void CheckedReader::Read(void* bytes, std::size_t count)
{
  auto* next = static_cast<unsigned char*>(bytes);
  while (count > 0)
  {
    if (this->Taken == this->Buffer.size())
    {
      this->ReadBuffer();
    }
    const std::size_t part = std::min(count, this->Buffer.size() - this->Taken);
    std::memcpy(next, this->Buffer.data() + this->Taken, part);
    this->Taken += part;
    next += part;
    count -= part;
  }
}

void CheckedReader::Need(std::uint64_t count, std::size_t bytes) const
{
  if (count > (this->Left + this->Buffer.size() - this->Taken) / std::max<std::size_t>(bytes, 1))
  {
    this->Refuse("is damaged");
  }
}

std::size_t CheckedReader::GetCount(std::size_t bytes)
{
  const auto count = this->Get<std::uint64_t>();
  this->Need(count, bytes);
  return static_cast<std::size_t>(count);
}

std::string CheckedReader::GetText()
{
  std::string text(this->GetCount(1), ' ');
  this->Read(text.data(), text.size());
  return text;
}

void FlushFolder(const std::string& folder)
{
#ifdef _WIN32
  static_cast<void>(folder);
#else
  const int opened =
    open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened >= 0)
  {
    fsync(opened);
    close(opened);
  }
#endif
}
}
