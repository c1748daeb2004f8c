// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFolderLock_h
#define volumicFolderLock_h

#include "Core/Common/CheckedFile.h"

#include <memory>
#include <string>
#include <vector>

namespace volumic
{
/** What stands under the name is not ours, or holds what is not: it is neither read nor touched. */
struct ForeignFolder : FileError
{
  using FileError::FileError;
};

/**
 * A folder of our own, which no other object has at the same time, in this process or in another
 * one. It ends with the object, and with the process, however that ends. Where the system, or the
 * file system, has no locks nobody is kept out.
 */
class FolderLock
{
public:
  /**
   * Makes the folder where there is none, for its owner alone. The empty file `lock` in it tells
   * that it is ours.
   * @return null if it is another object's.
   * @throws FileError if it cannot be made; ForeignFolder if a link, a file, or a folder of
   * somebody else or with other things stands in its place.
   */
  static std::unique_ptr<FolderLock> Take(const std::string& folder);

  /** Whether somebody has it; also where that cannot be found out. */
  static bool IsHeld(const std::string& folder);

  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /** Removes the folder, which stays where something is in it still; nobody else gets it before. */
  void RemoveFolder();

private:
  FolderLock(const std::string& folder, int file) : Folder(folder), File(file) {}

  std::string Folder;
  int File; ///< of the system; -1: none
};

/** What is in a directory; nothing where that cannot be read. */
std::vector<std::string> NamesIn(const std::string& directory);

/** Why no files can be made in a directory; empty: they can. */
std::string WhyNoFilesIn(const std::string& directory);
}

#endif
