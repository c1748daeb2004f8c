// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchFile.h"

#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchMemory.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#if defined(__linux__) && defined(__LP64__)

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <linux/fs.h>
#include <linux/magic.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/statfs.h>
#include <unistd.h>

namespace volumic
{
namespace
{
std::size_t PageSize()
{
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

std::size_t WholePages(std::size_t bytes)
{
  return (bytes + PageSize() - 1) / PageSize() * PageSize();
}

std::string Reason(int error)
{
  return std::generic_category().message(error);
}

/** Closes itself. */
struct OpenFile
{
  int Descriptor;
  explicit OpenFile(int descriptor) : Descriptor(descriptor) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile()
  {
    if (this->Descriptor >= 0)
    {
      close(this->Descriptor);
    }
  }
};

/** A file that no directory shows; -1 and errno where none can be made. */
int OpenNameless(const std::string& directory)
{
  const int file = open(directory.c_str(), O_TMPFILE | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0)
  {
    return file;
  }
  // Not all file systems have such files: one with a name, which it loses at once.
  std::string name = directory + "/volumic-XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0)
  {
    unlink(name.c_str());
  }
  return named;
}

/** Else btrfs would take new room for what is written again, which may not be there. */
void WriteInPlace(int file)
{
  int flags = 0;
  if (ioctl(file, FS_IOC_GETFLAGS, &flags) == 0)
  {
    flags |= FS_NOCOW_FL;
    ioctl(file, FS_IOC_SETFLAGS, &flags); // Other file systems refuse, and need it not.
  }
}

/** Takes room on the disk. @return an error number, 0 for none. */
int Reserve(int file, std::size_t bytes)
{
  // The system would end the process with a signal (SIGXFSZ).
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && bytes > limit.rlim_cur)
  {
    return EFBIG;
  }
  int error = EINTR;
  while (error == EINTR)
  {
    error = posix_fallocate(file, 0, static_cast<off_t>(bytes));
  }
  return error;
}
}

std::string CheckedScratchDirectory(const std::string& given)
{
  const char* ofSystem = std::getenv("TMPDIR");
  const bool isFromSystem = given.empty() && ofSystem && *ofSystem;
  const std::string chosen = !given.empty() ? given : (isFromSystem ? ofSystem : "/var/tmp");
  std::error_code error;
  const std::string directory = std::filesystem::absolute(chosen, error).string();
  const OpenFile file(OpenNameless(directory));
  if (file.Descriptor < 0)
  {
    const int reason = errno;
    Refuse("Scratch Directory ", directory, isFromSystem ? " (of TMPDIR)" : "",
      " cannot be used: ", Reason(reason),
      ". Choose a directory that exists and in which you may make files.");
  }
  UnmapScratchFile(MapScratchFile(directory, PageSize()), PageSize());
  return directory;
}

bool IsMemory(const std::string& directory)
{
  struct statfs system
  {
  };
  if (statfs(directory.c_str(), &system) != 0)
  {
    return false;
  }
  return static_cast<std::uint32_t>(system.f_type) == TMPFS_MAGIC ||
    static_cast<std::uint32_t>(system.f_type) == RAMFS_MAGIC;
}

std::size_t FreeRoom(const std::string& directory)
{
  struct statfs system
  {
  };
  return statfs(directory.c_str(), &system) == 0 && system.f_blocks > 0
    ? static_cast<std::size_t>(system.f_bavail) * static_cast<std::size_t>(system.f_bsize)
    : SIZE_MAX;
}

void* MapScratchFile(const std::string& directory, std::size_t bytes)
{
  const std::size_t size = WholePages(bytes);
  const OpenFile file(OpenNameless(directory));
  int error = errno;
  if (file.Descriptor >= 0)
  {
    WriteInPlace(file.Descriptor);
    // Not tried where it cannot be had: all would be taken for a moment, and others fail.
    error = size > FreeRoom(directory) ? ENOSPC : Reserve(file.Descriptor, size);
    if (error == EFBIG)
    {
      throw ScratchFull(
        Join("Scratch Directory ", directory, " can't take a file of ", Mebibytes(bytes),
          " MiB: files may not be as large there (ulimit -f). Allow larger "
          "files, choose another Scratch Directory, or raise Memory Limit."));
    }
    void* memory = error == 0
      ? mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file.Descriptor, 0)
      : MAP_FAILED;
    if (memory != MAP_FAILED)
    {
      // Else a look at one voxel may take 2 MiB, and a few hundred looks all that is free.
      madvise(memory, size, MADV_NOHUGEPAGE);
      return memory;
    }
    error = error == 0 ? errno : error;
  }
  if (error == ENOSPC || error == EDQUOT)
  {
    throw ScratchFull(Join("Scratch Directory ", directory, " has no room for ", Mebibytes(bytes),
      " MiB more: ", Mebibytes(FreeRoom(directory)), " MiB are free (", Reason(error),
      "). Make room, choose another Scratch Directory, or raise Memory Limit."));
  }
  throw std::runtime_error(Join("Scratch Directory ", directory, " cannot be used for ",
    Mebibytes(bytes), " MiB: ", Reason(error), ". Choose another one."));
}

void UnmapScratchFile(void* memory, std::size_t bytes) noexcept
{
  munmap(memory, WholePages(bytes));
}

void* MapZeroed(std::size_t bytes)
{
  const std::size_t size = WholePages(bytes);
  void* memory =
    mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  madvise(memory, size, MADV_NOHUGEPAGE); // Else each byte may take 2 MiB.
  return memory;
}

void DropPages(void* memory, std::size_t bytes) noexcept
{
  madvise(memory, bytes, MADV_DONTNEED);
}

void ReadPagesAhead(const void* memory, std::size_t bytes) noexcept
{
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = begin / PageSize() * PageSize();
  madvise(reinterpret_cast<void*>(first), begin + bytes - first, MADV_WILLNEED);
}

void ProtectPages(void* memory, std::size_t bytes) noexcept
{
  mprotect(memory, WholePages(bytes), PROT_READ);
}

void CallAtForks(void (*before)(), void (*inParent)(), void (*inChild)())
{
  pthread_atfork(before, inParent, inChild);
}

ResidentMemoryMeter::ResidentMemoryMeter() : File(open("/proc/self/statm", O_RDONLY | O_CLOEXEC)) {}

ResidentMemoryMeter::~ResidentMemoryMeter()
{
  if (this->File >= 0)
  {
    close(this->File);
  }
}

ResidentMemory ResidentMemoryMeter::Read() const
{
  char text[128] = {};
  unsigned long long all = 0;
  unsigned long long ofFiles = 0;
  ResidentMemory memory;
  // Pages: of the address space, resident, and of these those that files hold.
  if (this->File >= 0 && pread(this->File, text, sizeof text - 1, 0) > 0 &&
    std::sscanf(text, "%*u %llu %llu", &all, &ofFiles) == 2)
  {
    memory.All = static_cast<std::size_t>(all) * PageSize();
    memory.Anonymous = static_cast<std::size_t>(std::max(all, ofFiles) - ofFiles) * PageSize();
  }
  return memory;
}
}

#else

namespace volumic
{
std::string CheckedScratchDirectory(const std::string&)
{
  return {};
}

bool IsMemory(const std::string&)
{
  return false;
}

std::size_t FreeRoom(const std::string&)
{
  return 0;
}

void* MapScratchFile(const std::string&, std::size_t)
{
  throw std::bad_alloc();
}

void UnmapScratchFile(void*, std::size_t) noexcept {}

void* MapZeroed(std::size_t)
{
  throw std::bad_alloc();
}

void DropPages(void*, std::size_t) noexcept {}

void ReadPagesAhead(const void*, std::size_t) noexcept {}

void ProtectPages(void*, std::size_t) noexcept {}

void CallAtForks(void (*)(), void (*)(), void (*)()) {}

ResidentMemoryMeter::ResidentMemoryMeter() : File(-1) {}

ResidentMemoryMeter::~ResidentMemoryMeter() = default;

ResidentMemory ResidentMemoryMeter::Read() const
{
  return {};
}
}

#endif
