// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/ScratchMemory.h"

#include "Core/Common/ThrowInvalidArgument.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#ifdef _WIN32
#include <malloc.h>
#endif

#if defined(__linux__) && defined(__LP64__)
#define VOLUMIC_MAPS_FILES
#include <fcntl.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>
#endif

#ifdef __SANITIZE_ADDRESS__
extern "C" int __sanitizer_get_ownership(const volatile void* memory); // GCC has no header for it.
#endif

namespace volumic
{
namespace
{
std::mutex theMutex;
std::vector<std::string> theDirectories; ///< of all existing objects; the last one is used

std::string DirectoryInUse()
{
  const std::lock_guard<std::mutex> lock(theMutex);
  return theDirectories.empty() ? std::string() : theDirectories.back();
}

#ifdef __SANITIZE_ADDRESS__
// AddressSanitizer guards the surroundings of heap arrays, but not of mappings.
constexpr bool HeapIsGuarded = true;

bool IsOnGuardedHeap(const void* memory)
{
  return __sanitizer_get_ownership(memory) != 0;
}
#else
constexpr bool HeapIsGuarded = false;

bool IsOnGuardedHeap(const void*)
{
  return false;
}
#endif

void* AllocateOnHeap(std::size_t bytes, std::size_t alignment)
{
#ifdef _WIN32
  void* memory = _aligned_malloc(bytes, alignment);
#else
  const std::size_t least = std::max(alignment, alignof(std::max_align_t));
  void* memory = least == alignof(std::max_align_t)
    ? std::malloc(bytes)
    : std::aligned_alloc(least, (bytes + least - 1) / least * least);
#endif
  if (!memory && bytes > 0)
  {
    throw std::bad_alloc();
  }
  return memory;
}

void FreeOnHeap(void* memory) noexcept
{
#ifdef _WIN32
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

#ifdef VOLUMIC_MAPS_FILES
/** File without a name. */
class ScratchFile
{
public:
  explicit ScratchFile(const std::string& directory)
    : Descriptor(open(directory.c_str(), O_TMPFILE | O_EXCL | O_RDWR | O_CLOEXEC, 0600))
  {
    if (this->Descriptor < 0) // The file system may lack such files.
    {
      std::string name = directory + "/volumic-XXXXXX";
      this->Descriptor = mkostemp(name.data(), O_CLOEXEC);
      if (this->Descriptor < 0)
      {
        ThrowInvalidArgument("Scratch Directory ", directory,
          " cannot be used: ", std::generic_category().message(errno),
          ". Choose a directory that exists and in which you may create files.");
      }
      unlink(name.c_str());
    }
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() { close(this->Descriptor); }

  /** Take space on the disk. @return an error number, 0 for none. */
  int Reserve(std::size_t bytes) const
  {
    int flags = 0;
    if (ioctl(this->Descriptor, FS_IOC_GETFLAGS, &flags) == 0)
    {
      flags |= FS_NOCOW_FL; // Otherwise btrfs takes new space for each page that is written again.
      ioctl(this->Descriptor, FS_IOC_SETFLAGS, &flags);
    }
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && bytes > limit.rlim_cur)
    {
      return EFBIG; // The system would end the process by SIGXFSZ.
    }
    struct statvfs system
    {
    };
    if (fstatvfs(this->Descriptor, &system) == 0 && system.f_blocks > 0 &&
      bytes / system.f_frsize >= system.f_bavail)
    {
      return ENOSPC; // Trying would take all space for a moment.
    }
    int error = EINTR;
    while (error == EINTR)
    {
      error = posix_fallocate(this->Descriptor, 0, static_cast<off_t>(bytes));
    }
    return error;
  }

  int Get() const { return this->Descriptor; }

private:
  int Descriptor;
};

void* Map(const std::string& directory, std::size_t bytes)
{
  constexpr int access = PROT_READ | PROT_WRITE;
  void* memory = MAP_FAILED;
  if (directory.empty())
  {
    memory = mmap(nullptr, bytes, access, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  }
  else
  {
    const ScratchFile file(directory);
    const int error = file.Reserve(bytes);
    if (error != 0)
    {
      throw ScratchFull(Join("Scratch Directory ", directory, " lacks space for a file of ",
        (bytes >> 20) + 1, " MiB: ", std::generic_category().message(error),
        error == EFBIG ? ". Allow larger files (ulimit -f), or choose another directory."
                       : ". Free space there, or choose another directory."));
    }
    memory = mmap(nullptr, bytes, access, MAP_SHARED, file.Get(), 0);
  }
  if (memory == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  madvise(memory, bytes, MADV_NOHUGEPAGE); // Otherwise each byte may take 2 MiB.
  return memory;
}
#endif

}

ScratchMemory::ScratchMemory(const std::string& directory) : Directory(directory)
{
  if (directory.empty())
  {
    return;
  }
#ifdef VOLUMIC_MAPS_FILES
  munmap(Map(directory, 1), 1); // Report errors before anything is computed.
#else
  ThrowInvalidArgument("Scratch Directory is ", directory,
    ", but arrays can be mapped to files on Linux with 64 bits only. Clear Scratch Directory.");
#endif
  const std::lock_guard<std::mutex> lock(theMutex);
  theDirectories.push_back(directory);
}

ScratchMemory::~ScratchMemory()
{
  if (!this->Directory.empty())
  {
    const std::lock_guard<std::mutex> lock(theMutex);
    theDirectories.erase(std::find(theDirectories.begin(), theDirectories.end(), this->Directory));
  }
}

bool ScratchMemory::IsUsed()
{
  return !DirectoryInUse().empty();
}

void* AllocateLarge(std::size_t bytes, std::size_t alignment)
{
  const bool isLarge = bytes >= ScratchMemory::LargeBytes;
#ifdef VOLUMIC_MAPS_FILES
  const std::string directory = isLarge ? DirectoryInUse() : std::string();
  if (isLarge && (!HeapIsGuarded || !directory.empty()))
  {
    return Map(directory, bytes);
  }
#endif
  void* memory = AllocateOnHeap(bytes, alignment);
  if (isLarge || ZeroedAllocations::AreOn())
  {
    std::memset(memory, 0, bytes);
  }
  return memory;
}

void FreeLarge(void* memory, std::size_t bytes) noexcept
{
#ifdef VOLUMIC_MAPS_FILES
  if (memory && bytes >= ScratchMemory::LargeBytes && !IsOnGuardedHeap(memory))
  {
    munmap(memory, bytes);
    return;
  }
#endif
  static_cast<void>(bytes);
  FreeOnHeap(memory);
}
}
