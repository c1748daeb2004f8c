// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFolderLock_h
#define volumicFolderLock_h

#include <memory>
#include <string>

namespace volumic
{
/**
 * A folder of our own, which no other object has at the same time, in this process or in another
 * one. It ends with the object, and with the process, however that ends. Where the system, or the
 * file system, has no locks nobody is kept out.
 */
class FolderLock
{
public:
  /**
   * Makes the folder where there is none, for its owner alone.
   * @return null if it is another object's.
   * @throws FileError if it cannot be made, or belongs to somebody else.
   */
  static std::unique_ptr<FolderLock> Take(const std::string& folder);

  /** Whether somebody has it; also where that cannot be found out. */
  static bool IsHeld(const std::string& folder);

  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /** Removes the folder with all that is in it; nobody else gets it before it is gone. */
  void RemoveFolder();

private:
  FolderLock(const std::string& folder, int file) : Folder(folder), File(file) {}

  std::string Folder;
  int File; ///< of the system; -1: none
};

/** Why no files can be made in a directory; empty: they can. */
std::string WhyNoFilesIn(const std::string& directory);
}

#endif
