// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFiles.h"

#include "Descriptor.h"
#include "ToolErrors.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

fs::path FolderOf(const fs::path& file)
{
  return file.parent_path().empty() ? fs::path(".") : file.parent_path();
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
    Staged(this->IsStream ? fs::temp_directory_path().string() : FolderOf(this->Name).string())
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

// ---- Before the work begins ---------------------------------------------------------------------

namespace
{
/** The same for all names of a file, whatever links lead to it. */
using FileId = std::pair<dev_t, ino_t>;

/** Names of files by what they are. */
using FileNames = std::map<FileId, std::string>;

/** False if there is no such file. */
bool FindId(const fs::path& path, FileId& id)
{
  struct stat facts
  {
  };
  const bool isThere = stat(path.c_str(), &facts) == 0;
  id = { facts.st_dev, facts.st_ino };
  return isThere;
}

/** The next folder upwards that is there: where one would be made. */
fs::path FolderThatIsThere(fs::path folder)
{
  // A link to nowhere cannot be made a folder.
  while (!folder.empty() && !fs::exists(folder) && !fs::is_symlink(folder))
  {
    folder = folder.parent_path();
  }
  return folder.empty() ? fs::path(".") : folder;
}

/** @throws Failure unless files can be made in the folder, which a trial alone tells. */
void TryFolder(const fs::path& folder)
{
  FailIf(!fs::is_directory(folder), "cannot be written: " + folder.string() + " is no folder");
  StagedFiles trial(folder.string());
}

void TryFile(const std::string& name)
{
  const fs::path path = FollowLinks(name);
  FailIf(fs::is_directory(path), "cannot be written: it is a folder");
  if (fs::exists(path) && access(path.c_str(), W_OK) != 0)
  {
    throw Failure("cannot be written: " + std::generic_category().message(errno));
  }
  if (IsStreamName(name))
  {
    return;
  }
  const fs::path folder = FolderOf(path);
  FailIf(!fs::is_directory(folder), "there is no folder " + folder.string());
  TryFolder(folder);
}

/** The folder of an output that consists of several files; empty for others. */
fs::path PiecesFolder(const OutputName& output)
{
  return output.Form == OutputName::Kind::Folder || output.Form == OutputName::Kind::Place
    ? fs::path(output.Name)
    : output.Form == OutputName::Kind::Blocks
    ? fs::path(FollowLinks(output.Name)).replace_extension()
    : fs::path();
}

/** Whether the output may come to write a file of this name in its folder. */
bool IsPieceName(const OutputName& output, const std::string& name)
{
  if (output.Form == OutputName::Kind::Place)
  {
    return false;
  }
  const std::string start = output.Form == OutputName::Kind::Folder
    ? output.Prefix + "-"
    : PiecesFolder(output).filename().string() + "_";
  return name.compare(0, start.size(), start) == 0;
}

/** @throws Failure if a file that the output may come to write in its folder is one of `taken`. */
void CheckPieces(const OutputName& output, const FileNames& taken)
{
  const fs::path folder = PiecesFolder(output);
  if (!fs::is_directory(folder))
  {
    return;
  }
  for (const auto& entry : fs::directory_iterator(folder))
  {
    FileId id;
    if (IsPieceName(output, entry.path().filename().string()) && FindId(entry.path(), id) &&
      taken.count(id) > 0)
    {
      throw Failure("cannot be written: " + entry.path().string() +
        " would be replaced, which is the input " + taken.at(id));
    }
  }
}

void TryOutput(const OutputName& output, const FileNames& inputs)
{
  if (output.Form == OutputName::Kind::File || output.Form == OutputName::Kind::Blocks)
  {
    TryFile(output.Name);
    FileId id;
    if (FindId(output.Name, id) && inputs.count(id) > 0)
    {
      throw Failure("cannot be written: it is the input " + inputs.at(id));
    }
  }
  if (output.Form != OutputName::Kind::File)
  {
    TryFolder(FolderThatIsThere(PiecesFolder(output)));
    CheckPieces(output, inputs);
  }
}

/** A name for the place of an output that no other place has, links and dots in it or not. */
std::string PlaceOf(const OutputName& output)
{
  std::error_code failed;
  const fs::path place = fs::weakly_canonical(FollowLinks(output.Name), failed);
  // A slash at the end is an empty file name.
  return (place.has_filename() ? place : place.parent_path()).string();
}

/** @throws Failure if both outputs would write the same file. */
void CheckPair(const OutputName& a, const OutputName& b)
{
  if (IsStreamName(a.Name) || IsStreamName(b.Name))
  {
    return;
  }
  FileId idOfA;
  FileId idOfB;
  const bool isSame =
    PlaceOf(a) == PlaceOf(b) || (FindId(a.Name, idOfA) && FindId(b.Name, idOfB) && idOfA == idOfB);
  const bool isSameFolder = a.Form == OutputName::Kind::Folder && a.Form == b.Form;
  const auto holds = [](const OutputName& several, const OutputName& one)
  {
    const fs::path place = PlaceOf(one);
    std::error_code failed;
    return several.Form != OutputName::Kind::File &&
      fs::weakly_canonical(PiecesFolder(several), failed) == place.parent_path() &&
      IsPieceName(several, place.filename().string());
  };
  // Two folders of surfaces may be one: their names begin differently.
  FailIf((isSame && !isSameFolder) || holds(a, b) || holds(b, a),
    "cannot be written: " + b.Name + " would take the same place");
}
}

void CheckOutputs(const std::vector<OutputName>& outputs, const std::vector<std::string>& inputs)
{
  FileNames inputNames;
  for (const std::string& name : inputs)
  {
    FileId id;
    if (FindId(name, id))
    {
      inputNames.emplace(id, name);
    }
  }
  for (std::size_t i = 0; i < outputs.size(); ++i)
  {
    try
    {
      TryOutput(outputs[i], inputNames);
      for (std::size_t j = 0; j < i; ++j)
      {
        CheckPair(outputs[i], outputs[j]);
      }
    }
    catch (const Failure& failure)
    {
      throw Failure(outputs[i].Name + ": " + failure.what());
    }
    catch (const fs::filesystem_error& error)
    {
      throw Failure(outputs[i].Name + ": cannot be written: " + error.code().message());
    }
  }
}
}
