// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicOutputFiles_h
#define volumicOutputFiles_h

#include <cstddef>
#include <string>
#include <vector>

namespace tool
{
/**
 * Files that are written beside their place, and moved there when they are whole: whoever looks
 * finds the old file or the new one, never half of one, whenever the program is killed.
 *
 * They lie in a hidden folder of their own (.volumic-XXXXXX) within the folder they are for. So
 * they have their final names, which files of several parts tell each other, and moving them stays
 * within one file system. What has not been moved goes with this object; a killed program leaves
 * the hidden folder.
 */
class StagedFiles
{
public:
  /** @throws Failure if the folder cannot be written to. */
  explicit StagedFiles(const std::string& folder);
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /** The hidden folder, without a slash at the end. */
  const std::string& Folder() const { return this->Hidden; }

  /**
   * Have all files on the disk, then move each to its place, those in subfolders first. Files that
   * are replaced hand down their permissions. @throws Failure if that is not possible.
   */
  void Publish();

private:
  std::string Target;
  std::string Hidden;
};

/**
 * One file to write, and what its format puts into a folder beside it. Where the name is a symbolic
 * link the file it points to is replaced. Devices and pipes (/dev/stdout) get a copy of the whole
 * file when it is published.
 */
class OutputFile
{
public:
  /** @throws Failure if the folder cannot be written to. */
  explicit OutputFile(const std::string& name);

  /** What is to be written: it has the suffix of the name. */
  std::string Path() const;

  /** @throws Failure if the file cannot take its place. */
  void Publish();

private:
  std::string Name;
  bool IsStream; ///< no regular file
  StagedFiles Staged;
};

/** The name that symbolic links at `name` lead to; the last need not exist. */
std::string FollowLinks(const std::string& name);

/** Whether `name` is a device, a pipe, or one of the program's own streams. */
bool IsStreamName(const std::string& name);

/** Make a file of these bytes. @throws Failure with the system's reason, without the name. */
void WriteBytes(const std::string& path, const char* bytes, std::size_t count);

// ---- Before the work begins ---------------------------------------------------------------------

/** What is to be written, as the command line names it. */
struct OutputName
{
  enum class Kind
  {
    File,
    Blocks, ///< a .vtm or .pvtp, and the files STEM/STEM_... beside it
    Folder, ///< the files Prefix-....vtp in it; it may have to be made
    Place   ///< a folder likewise, of files that are not known yet
  };
  std::string Name;
  Kind Form = Kind::File;
  std::string Prefix; ///< of a Folder
};

/**
 * Find out before the work begins whether the outputs can be written: their folders are there and
 * let files be made in them, no file is a folder or write-protected, and none is one of the inputs
 * or another output, by whatever name or link.
 * @throws Failure that names the output.
 */
void CheckOutputs(const std::vector<OutputName>& outputs, const std::vector<std::string>& inputs);
}

#endif
