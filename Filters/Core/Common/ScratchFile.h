// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicScratchFile_h
#define volumicScratchFile_h

#include <cstddef>
#include <string>

/**
 * What ScratchMemory needs of the system: memory that is a file, and how much memory the process
 * has. Linux of 64 bits; elsewhere ScratchIsPossible is false, and the rest is not to be called.
 */
namespace volumic
{
#if defined(__linux__) && defined(__LP64__)
constexpr bool ScratchIsPossible = true;
#else
constexpr bool ScratchIsPossible = false;
#endif

constexpr std::size_t Mebibyte = std::size_t(1) << 20;

/** Bytes in mebibytes, rounded up, for messages. */
constexpr double Mebibytes(std::size_t bytes)
{
  return static_cast<double>((bytes + Mebibyte - 1) / Mebibyte);
}

/**
 * So many bytes are dropped at a time; mappings begin and end with whole pages, which are smaller.
 */
constexpr std::size_t ScratchStep = 2 * Mebibyte;

/**
 * The directory that files are made in, as an absolute path: the given one, or, where that is
 * empty, TMPDIR or /var/tmp. A file is made in it, for a trial.
 * @throws std::invalid_argument where that fails; ScratchFull.
 */
std::string CheckedScratchDirectory(const std::string& given);

/** Whether a directory's files are memory themselves (tmpfs), so that nothing is won. */
bool IsMemory(const std::string& directory);

/** Bytes that a user may still fill in the file system of a directory; all where it is unknown. */
std::size_t FreeRoom(const std::string& directory);

/**
 * Zeros, in a file without a name: it is gone with the mapping, or the process. Its room on the
 * disk is taken beforehand, so that writing to the memory cannot fail. Where the file system takes
 * the room in name only, as some do that compress or are of a network, a disk that is full ends the
 * process by SIGBUS, which the program `volumic` tells in words.
 * @throws ScratchFull where there is no room; std::runtime_error where the system refuses.
 */
void* MapScratchFile(const std::string& directory, std::size_t bytes);
void UnmapScratchFile(void* memory, std::size_t bytes) noexcept;
/**
 * Zeros, in memory; pages that have not been written take none, even where there are more of them
 * than the machine has. Unmapped as a file. @throws std::bad_alloc.
 */
void* MapZeroed(std::size_t bytes);

/** Takes pages of a mapping out of the process; they come back when they are touched. */
void DropPages(void* memory, std::size_t bytes) noexcept;
/** Has pages of a mapping read from the disk, without waiting. */
void ReadPagesAhead(const void* memory, std::size_t bytes) noexcept;
/** Lets a mapping only be read from now on. */
void ProtectPages(void* memory, std::size_t bytes) noexcept;

/** Has these called whenever the process is forked, the last one in the child. */
void CallAtForks(void (*before)(), void (*inParent)(), void (*inChild)());

struct ResidentMemory
{
  std::size_t All = 0;       ///< Bytes; 0 where it is not known.
  std::size_t Anonymous = 0; ///< Bytes that no file holds: heap and stacks.
};

/** Asks the system again and again, in 2 microseconds. A process that was forked needs its own. */
class ResidentMemoryMeter
{
public:
  ResidentMemoryMeter();
  ~ResidentMemoryMeter();
  ResidentMemoryMeter(const ResidentMemoryMeter&) = delete;
  ResidentMemoryMeter& operator=(const ResidentMemoryMeter&) = delete;

  ResidentMemory Read() const;

private:
  int File;
};
}

#endif
