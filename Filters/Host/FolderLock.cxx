// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/FolderLock.h"

#include "Core/Common/CheckedFile.h"
#include "Core/Common/Join.h"

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <thread>

#ifndef _WIN32
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace volumic
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* LockName = "lock";
/** Tries to get a lock: who only looks whether it is held has it for a moment. */
constexpr int Tries = 5;

std::string ReasonOf(int error)
{
  return std::generic_category().message(error);
}

#ifndef _WIN32
std::string LockFileIn(const std::string& folder)
{
  return folder + "/" + LockName;
}

bool IsLockedByAnother(int file)
{
  return flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

/** A folder that others may write to may lead elsewhere than it seems. */
void MakeFolder(const std::string& folder)
{
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
  {
    throw FileError(Join(folder, " cannot be made (", ReasonOf(errno), ")"));
  }
  struct stat facts
  {
  };
  if (lstat(folder.c_str(), &facts) != 0 || !S_ISDIR(facts.st_mode) ||
    facts.st_uid != geteuid())
  {
    throw FileError(Join(folder, " is no folder of yours"));
  }
}

/** Whether the name still leads to the file: who had it before may have removed it. */
bool IsThere(const std::string& name, int file)
{
  struct stat ofName
  {
  };
  struct stat ofFile
  {
  };
  return stat(name.c_str(), &ofName) == 0 && fstat(file, &ofFile) == 0 &&
    ofName.st_ino == ofFile.st_ino && ofName.st_dev == ofFile.st_dev;
}
#endif
}

#ifdef _WIN32
std::unique_ptr<FolderLock> FolderLock::Take(const std::string& folder)
{
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (failed)
  {
    throw FileError(Join(folder, " cannot be made (", failed.message(), ")"));
  }
  return std::unique_ptr<FolderLock>(new FolderLock(folder, -1));
}

bool FolderLock::IsHeld(const std::string&)
{
  return false;
}

FolderLock::~FolderLock() = default;

std::string WhyNoFilesIn(const std::string& directory)
{
  std::error_code failed;
  return fs::is_directory(directory, failed) ? "" : ReasonOf(ENOTDIR);
}
#else
std::unique_ptr<FolderLock> FolderLock::Take(const std::string& folder)
{
  while (true)
  {
    MakeFolder(folder);
    const std::string name = LockFileIn(folder);
    const int file = open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (file < 0 && errno == ENOENT)
    {
      continue; // Removed since.
    }
    if (file < 0)
    {
      throw FileError(Join(name, " cannot be made (", ReasonOf(errno), ")"));
    }
    std::unique_ptr<FolderLock> lock(new FolderLock(folder, file));
    for (int left = Tries; IsLockedByAnother(file); --left)
    {
      if (left == 0)
      {
        return nullptr;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (IsThere(name, file))
    {
      return lock;
    }
  }
}

bool FolderLock::IsHeld(const std::string& folder)
{
  const int file = open(LockFileIn(folder).c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0)
  {
    return errno != ENOENT;
  }
  const bool isHeld = IsLockedByAnother(file);
  close(file);
  return isHeld;
}

FolderLock::~FolderLock()
{
  if (this->File >= 0)
  {
    close(this->File);
  }
}

std::string WhyNoFilesIn(const std::string& directory)
{
  struct stat facts
  {
  };
  if (stat(directory.c_str(), &facts) != 0)
  {
    return ReasonOf(errno);
  }
  if (!S_ISDIR(facts.st_mode))
  {
    return ReasonOf(ENOTDIR);
  }
  return access(directory.c_str(), W_OK | X_OK) == 0 ? "" : ReasonOf(errno);
}
#endif

void FolderLock::RemoveFolder()
{
  // The lock goes last: who takes it from then on finds the folder empty, or makes a new one.
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(this->Folder, ignored))
  {
    if (entry.path().filename() != LockName)
    {
      fs::remove_all(entry.path(), ignored);
    }
  }
  fs::remove(fs::path(this->Folder) / LockName, ignored);
  fs::remove(this->Folder, ignored);
}
}
