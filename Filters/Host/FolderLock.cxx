// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/FolderLock.h"

#include "Core/Common/Join.h"

#include <algorithm>
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
    throw ForeignFolder(Join(folder, " is no folder of yours"));
  }
}

/** -1 where it has been removed since. */
int OpenLock(const std::string& folder)
{
  const std::string name = LockFileIn(folder);
  const int options = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  int file = open(name.c_str(), options);
  if (file < 0 && errno == ENOENT)
  {
    const std::vector<std::string> names = NamesIn(folder);
    if (!names.empty() && std::find(names.begin(), names.end(), LockName) == names.end())
    {
      throw ForeignFolder(Join(folder, " holds what Volumic has not made (", names.front(), ")"));
    }
    file = open(name.c_str(), options | O_CREAT, 0600);
  }
  if (file < 0 && errno == ENOENT)
  {
    return -1;
  }
  struct stat facts
  {
  };
  if (file < 0 || fstat(file, &facts) != 0 || !S_ISREG(facts.st_mode) || facts.st_size != 0 ||
    facts.st_uid != geteuid())
  {
    const std::string reason =
      file < 0 ? Join(" cannot be made (", ReasonOf(errno), ")") : " is no file of Volumic";
    close(file);
    throw ForeignFolder(name + reason);
  }
  return file;
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
    const int file = OpenLock(folder);
    if (file < 0)
    {
      continue;
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
    if (IsThere(LockFileIn(folder), file))
    {
      return lock;
    }
  }
}

bool FolderLock::IsHeld(const std::string& folder)
{
  const int file = open(LockFileIn(folder).c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
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
  fs::remove(fs::path(this->Folder) / LockName, ignored);
  fs::remove(this->Folder, ignored);
}

std::vector<std::string> NamesIn(const std::string& directory)
{
  std::vector<std::string> names;
  std::error_code failed;
  fs::directory_iterator entry(directory, failed);
  for (; !failed && entry != fs::directory_iterator(); entry.increment(failed))
  {
    names.push_back(entry->path().filename().string());
  }
  return names;
}
}
