// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFiles.h"

#include "Descriptor.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

std::string FolderOf(const std::string& name)
{
  const std::string folder = fs::path(name).parent_path().string();
  return folder.empty() ? "." : folder;
}

/** Give `path` the owner and the permissions of the file it replaces, as far as we may. */
void InheritPermissions(const std::string& path, const std::string& old)
{
  struct stat facts
  {
  };
  if (stat(old.c_str(), &facts) == 0 && S_ISREG(facts.st_mode))
  {
    const bool isTheirs = chown(path.c_str(), facts.st_uid, facts.st_gid) == 0;
    // Whom we cannot make the owner has to read it as before, through the group or as one of all.
    chmod(path.c_str(), facts.st_mode & (isTheirs ? 07777 : 0777));
  }
}

void MoveTo(const fs::path& from, const fs::path& to)
{
  std::error_code failed;
  fs::create_directories(to.parent_path(), failed);
  InheritPermissions(from.string(), to.string());
  if (rename(from.c_str(), to.c_str()) != 0)
  {
    throw Failure("cannot be written (" + to.string() + ": " + SystemReason() + ")");
  }
}

void CopyToStream(const std::string& from, const std::string& to)
{
  std::ifstream file(from, std::ios::binary);
  Descriptor stream(to, O_WRONLY | O_APPEND);
  bool isWritten = stream.IsOpen();
  std::vector<char> piece(1 << 16);
  while (isWritten && (file.read(piece.data(), piece.size()), file.gcount() > 0))
  {
    isWritten = stream.Write(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  NeedWritten(isWritten && stream.Close());
}
}

StagedFiles::StagedFiles(const std::string& folder) : Target(folder), Hidden(folder)
{
  if (this->Hidden.back() != '/')
  {
    this->Hidden += '/';
  }
  this->Hidden += ".volumic-XXXXXX";
  if (!mkdtemp(this->Hidden.data()))
  {
    throw Failure("cannot be written (the folder " + folder + ": " + SystemReason() + ")");
  }
}

StagedFiles::~StagedFiles()
{
  std::error_code ignored;
  fs::remove_all(this->Hidden, ignored);
}

void StagedFiles::Publish()
{
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(this->Hidden))
  {
    if (entry.is_regular_file())
    {
      files.push_back(entry.path().lexically_relative(this->Hidden));
    }
  }
  for (const fs::path& file : files)
  {
    Descriptor descriptor((this->Hidden / file).string(), O_RDONLY);
    NeedWritten(descriptor.IsOpen() && descriptor.Flush() && descriptor.Close());
  }
  // The file that names the others comes last.
  std::sort(files.begin(), files.end(),
    [](const fs::path& a, const fs::path& b)
    { return std::make_pair(!a.has_parent_path(), a) < std::make_pair(!b.has_parent_path(), b); });
  for (const fs::path& file : files)
  {
    MoveTo(this->Hidden / file, this->Target / file);
  }
  Descriptor(this->Target, O_RDONLY | O_DIRECTORY).Flush();
}

OutputFile::OutputFile(const std::string& name)
  : Name(FollowLinks(name)), IsStream(IsStreamName(name)),
    Staged(this->IsStream ? fs::temp_directory_path().string() : FolderOf(this->Name))
{
}

std::string OutputFile::Path() const
{
  return this->Staged.Folder() + "/" + fs::path(this->Name).filename().string();
}

void OutputFile::Publish()
{
  if (this->IsStream)
  {
    CopyToStream(this->Path(), this->Name);
  }
  else
  {
    this->Staged.Publish();
  }
}

std::string FollowLinks(const std::string& name)
{
  fs::path path = name;
  std::error_code failed;
  // The links of /dev and /proc are no names of files, but what is opened by them.
  for (int i = 0; i < 40 && !IsStreamName(name) && fs::is_symlink(path, failed); ++i)
  {
    path = path.parent_path() / fs::read_symlink(path, failed);
  }
  return path.string();
}

bool IsStreamName(const std::string& name)
{
  std::error_code failed;
  const fs::path path = fs::absolute(name, failed).lexically_normal();
  const fs::file_status status = fs::status(path, failed);
  const std::string start = path.has_root_path() ? (++path.begin())->string() : "";
  return (start == "dev" && path.string().compare(0, 9, "/dev/shm/") != 0) || start == "proc" ||
    (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status));
}

void WriteBytes(const std::string& path, const char* bytes, std::size_t count)
{
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  NeedWritten(file.IsOpen() && file.Write(bytes, count) && file.Close());
}

void NeedRoom(const std::string& path, std::size_t count)
{
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  NeedWritten(file.IsOpen() && file.Reserve(count) && file.Close() &&
    truncate(path.c_str(), 0) == 0);
}
}
