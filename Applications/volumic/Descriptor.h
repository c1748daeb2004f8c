// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDescriptor_h
#define volumicDescriptor_h

#include "ToolErrors.h"

#include <cerrno>
#include <cstddef>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>

namespace tool
{
/** The system's text for errno. */
inline std::string SystemReason(int error = errno)
{
  return std::generic_category().message(error);
}

/** @throws Failure with the system's reason, without a name, unless all could be written. */
inline void NeedWritten(bool isWritten)
{
  if (!isWritten)
  {
    throw Failure("cannot be written (" + SystemReason() + ")");
  }
}

/** An open file, by its name or its number, that closes itself. What fails leaves its reason in
 * errno. */
class Descriptor
{
public:
  Descriptor(const std::string& path, int flags)
    : Number(open(path.c_str(), flags | O_CLOEXEC, 0666))
  {
  }
  explicit Descriptor(int number) : Number(number) {}
  ~Descriptor() { this->Close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool IsOpen() const { return this->Number >= 0; }

  /** Whether all could be written. */
  bool Write(const char* bytes, std::size_t count)
  {
    while (count > 0)
    {
      const ssize_t written = write(this->Number, bytes, count);
      if (written < 0 && errno != EINTR)
      {
        return false;
      }
      const std::size_t done = written > 0 ? static_cast<std::size_t>(written) : 0;
      bytes += done;
      count -= done;
    }
    return true;
  }

  /** Write on from this byte of the file. */
  bool Seek(off_t place) { return lseek(this->Number, place, SEEK_SET) == place; }

  /** Whether the disk has it. Pipes and some network folders know no such request. */
  bool Flush() { return fsync(this->Number) == 0 || errno == EINVAL || errno == ENOTSUP; }

  /** Whether nothing was left to fail. */
  bool Close()
  {
    const bool isClosed = this->Number < 0 || close(this->Number) == 0;
    this->Number = -1;
    return isClosed;
  }

private:
  int Number;
};
}

#endif
