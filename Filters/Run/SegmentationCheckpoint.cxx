// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/SegmentationCheckpoint.h"

#include "Core/Common/CheckedFile.h"
#include "Core/Common/ContentHash.h"
#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Host/FolderLock.h"
#include "Input/SurfaceFile.h"

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* Prefix = "volumic-";
/** Begins each file; to be changed with the format, or with the bits of what a run makes of it. */
constexpr const char* Format = "Volumic checkpoint 7";

constexpr const char* LevelPrefix = "level-";
/** What former versions had beside files of levels. */
constexpr const char* FormerState = "state";

std::string FileIn(const fs::path& folder, int level)
{
  return (folder / Join(LevelPrefix, level)).string();
}

/** Of a name of such a file. */
std::optional<int> LevelOf(const std::string& name)
{
  int level = 0;
  const char* end = name.data() + name.size();
  if (name.rfind(LevelPrefix, 0) == 0)
  {
    const char* begin = name.data() + std::strlen(LevelPrefix);
    const std::from_chars_result read = std::from_chars(begin, end, level);
    if (read.ec == std::errc() && read.ptr == end)
    {
      return level;
    }
  }
  return std::nullopt;
}

/** That of the finest level, of what a folder holds; empty: none. */
std::string FileIn(const std::string& folder)
{
  std::optional<int> finest;
  for (const std::string& name : NamesIn(folder))
  {
    if (name == FormerState)
    {
      return (fs::path(folder) / name).string(); // Is refused as what it is.
    }
    const std::optional<int> level = LevelOf(name);
    finest = level && (!finest || *level < *finest) ? level : finest;
  }
  return finest ? FileIn(fs::path(folder), *finest) : std::string();
}

/** But for that of a level. */
void RemoveFilesIn(const std::string& folder, std::optional<int> but = std::nullopt)
{
  for (const std::string& name : NamesIn(folder))
  {
    std::error_code ignored;
    if ((name.rfind(LevelPrefix, 0) == 0 || name.rfind(FormerState, 0) == 0) &&
      (!but || LevelOf(name) != but))
    {
      fs::remove(fs::path(folder) / name, ignored);
    }
  }
}

/** Those of a level, in their order. */
std::vector<const SegmentationResults::Snapshot*> SnapshotsOf(
  const SegmentationResults& results, int level)
{
  std::vector<const SegmentationResults::Snapshot*> found;
  for (const SegmentationResults::Snapshot& snapshot : results.AllSnapshots())
  {
    if (snapshot.Level == level)
    {
      found.push_back(&snapshot);
    }
  }
  return found;
}

void WriteDescription(CheckedWriter& file, const SurfaceDescription& about)
{
  file.Put(about.Level);
  file.Put(about.Unit);
  file.Put(about.Iterations);
  file.Put(about.TotalIterations);
  file.PutText(about.StopReason);
  file.Put(about.Lost);
}

SurfaceDescription ReadDescription(CheckedReader& file)
{
  SurfaceDescription about;
  about.Level = file.Get<int>();
  about.Unit = file.Get<double>();
  about.Iterations = file.Get<int>();
  about.TotalIterations = file.Get<int>();
  about.StopReason = file.GetText();
  about.Lost = file.Get<LostParts>();
  return about;
}

void WriteLevel(CheckedWriter& file, const SegmentationResults& results, int level)
{
  const SegmentationResults::Level& result = results.Levels().at(level);
  WriteDescription(file, result.Description);
  file.Put(result.KeepsNone);
  file.Put(result.IsAtRest);
  WriteSurfaceTo(file, result.Surface);
  const auto snapshots = SnapshotsOf(results, level);
  file.Put<std::uint64_t>(snapshots.size());
  for (const SegmentationResults::Snapshot* snapshot : snapshots)
  {
    file.PutText(snapshot->Name);
    WriteSurfaceTo(file, snapshot->Surface);
  }
}

void ReadLevel(CheckedReader& file, SegmentationResults& results)
{
  SegmentationResults::Level result;
  result.Description = ReadDescription(file);
  result.KeepsNone = file.Get<bool>();
  result.IsAtRest = file.Get<bool>();
  result.Surface = ReadSurfaceFrom(file);
  const int level = result.Description.Level;
  results.SetLevel(level, result);
  for (auto left = file.Get<std::uint64_t>(); left > 0; --left)
  {
    const std::string snapshot = file.GetText();
    results.AddSnapshot(level, snapshot, ReadSurfaceFrom(file));
  }
}

/** What each file begins with. */
struct FileHead
{
  RunFingerprint Fingerprint;
  SegmentationCheckpoint::Place Place;
};

FileHead ReadHead(CheckedReader& file)
{
  if (file.GetText() != Format)
  {
    file.Refuse("was written by another version of Volumic");
  }
  FileHead head;
  head.Fingerprint = RunFingerprint::Read(file);
  head.Place.Level = file.Get<int>();
  head.Place.GoesOn = file.Get<bool>();
  return head;
}

/** As an absolute path. */
std::string CheckedDirectory(const std::string& given)
{
  const char* ofSystem = std::getenv("TMPDIR");
  const bool isFromSystem = given.empty() && ofSystem && *ofSystem;
  const std::string chosen = !given.empty() ? given : (isFromSystem ? ofSystem : "/var/tmp");
  std::error_code error;
  const fs::path directory = fs::absolute(chosen, error);
  const std::string reason = WhyNoFilesIn(directory.string());
  if (!reason.empty())
  {
    Refuse("Scratch Directory ", directory.string(), isFromSystem ? " (of TMPDIR)" : "",
      " cannot be used: ", reason,
      ". Choose a directory that exists and in which you may make files.");
  }
  return directory.string();
}
}

SegmentationCheckpoint::SegmentationCheckpoint(
  const std::string& directory, RunFingerprint fingerprint)
  : Directory(CheckedDirectory(directory)), IsShared(directory.empty()),
    Folder((fs::path(this->Directory) / (Prefix + HashText(fingerprint.Hash()))).string()),
    Fingerprint(std::move(fingerprint))
{
}

SegmentationCheckpoint::~SegmentationCheckpoint()
{
  this->RemoveIfEmpty();
}

void SegmentationCheckpoint::RemoveIfEmpty()
{
  if (this->Locked && FileIn(this->Folder).empty())
  {
    RemoveFilesIn(this->Folder);
    this->Locked->RemoveFolder();
    this->Locked.reset();
  }
}

std::optional<SegmentationCheckpoint::Place> SegmentationCheckpoint::PlaceOfFile() const
{
  const std::string name = FileIn(this->Folder);
  if (name.empty())
  {
    return std::nullopt;
  }
  CheckedReader file(name);
  return ReadHead(file).Place;
}

void SegmentationCheckpoint::CheckOthers() const
{
  // Of those that are there, and that nobody is at, the one that is most like this run is told of.
  std::string nearest;
  RunFingerprint before;
  int fewest = 0;
  std::error_code ignored;
  for (const std::string& name : NamesIn(this->Directory))
  {
    const std::string folder = (fs::path(this->Directory) / name).string();
    if (name.rfind(Prefix, 0) != 0 || fs::is_symlink(folder, ignored) || FileIn(folder).empty() ||
      FolderLock::IsHeld(folder))
    {
      continue;
    }
    try
    {
      CheckedReader file(FileIn(folder));
      const RunFingerprint found = ReadHead(file).Fingerprint;
      if (this->IsShared && !this->Fingerprint.IsSameVolume(found))
      {
        continue;
      }
      const int differences = this->Fingerprint.NumberOfDifferences(found);
      if (nearest.empty() || differences < fewest)
      {
        nearest = folder;
        before = found;
        fewest = differences;
      }
    }
    catch (const FileError&)
    {
      // Of another version, damaged, or another user's.
    }
  }
  if (!nearest.empty() && fewest == 0)
  {
    Refuse("Resume: the checkpoint ", nearest,
      " is of this volume and these settings, but has "
      "not their name. Rename it to ",
      this->Folder, ", or, to begin anew, remove it.");
  }
  if (!nearest.empty())
  {
    Refuse("Resume: the checkpoint ", nearest, " is of ",
      this->Fingerprint.IsSameVolume(before) ? "other settings: " : "another volume: ",
      this->Fingerprint.DifferencesFrom(before),
      ". Set it as it was, or, to begin anew, switch Resume off or choose another Scratch "
      "Directory.");
  }
}

std::optional<SegmentationCheckpoint::Place> SegmentationCheckpoint::Load(
  SegmentationResults& results, SurfaceAtRest& rest)
{
  if (FileIn(this->Folder).empty())
  {
    this->CheckOthers();
    return std::nullopt;
  }
  try
  {
    if (!this->TakeFolder())
    {
      Refuse("Resume: another run is at the checkpoint ", this->Folder,
        ". Wait until it has ended, or end it.");
    }
    CheckedReader file(FileIn(this->Folder));
    const FileHead head = ReadHead(file);
    rest.Load(file);
    for (auto left = file.Get<std::uint64_t>(); left > 0; --left)
    {
      ReadLevel(file, results);
    }
    this->Existing = head.Place;
    this->Resumed = head.Place.Level;
    return head.Place;
  }
  catch (const ForeignFolder&)
  {
    return std::nullopt; // Anybody may have put it there. Save() tells of it.
  }
  catch (const FileError& error)
  {
    Refuse("Resume: ", error.what(),
      ". Begin anew: switch Resume off, or remove that folder, or "
      "choose another Scratch Directory.");
  }
}

bool SegmentationCheckpoint::TakeFolder()
{
  if (!this->Locked)
  {
    this->Locked = FolderLock::Take(this->Folder);
  }
  return this->Locked != nullptr;
}

std::string SegmentationCheckpoint::Save(
  const SegmentationResults& results, const SurfaceAtRest& rest, const Place& place)
{
  if (this->HasFailed)
  {
    return "";
  }
  try
  {
    const bool isNew = !this->Locked;
    if (!this->TakeFolder())
    {
      this->HasFailed = true;
      return Join("Another run of the same volume and settings has its checkpoint in ",
        this->Folder, ": this one leaves none.");
    }
    try
    {
      this->Existing = isNew ? this->PlaceOfFile() : this->Existing;
    }
    catch (const FileError&)
    {
      this->Existing.reset(); // What cannot be read is replaced.
    }
    if (!this->Existing || this->Existing->Level >= place.Level)
    {
      this->Write(results, rest, place);
      this->Existing = place;
    }
    return "";
  }
  catch (const ForeignFolder& error)
  {
    this->HasFailed = true;
    return Join("No checkpoint is left, and none was read: ", error.what(),
      ". Remove it, if it is nobody's, or choose another Scratch Directory.");
  }
  catch (const std::exception& error)
  {
    this->HasFailed = true;
    this->RemoveIfEmpty();
    const std::string from = this->Existing
      ? Join(", and can be resumed from level ", this->Existing->Level, " only")
      : std::string();
    return Join("The checkpoint of level ", place.Level, " could not be left: ", error.what(),
      ". The run goes on without", from,
      ". Give Scratch Directory more room, or choose another one.");
  }
}

void SegmentationCheckpoint::Write(
  const SegmentationResults& results, const SurfaceAtRest& rest, const Place& place)
{
  CheckedWriter file(FileIn(fs::path(this->Folder), place.Level));
  file.PutText(Format);
  this->Fingerprint.Write(file);
  file.Put(place.Level);
  file.Put(place.GoesOn);
  rest.Save(file);
  file.Put<std::uint64_t>(results.Levels().size());
  // The coarser ones come first, as their snapshots do.
  for (auto level = results.Levels().rbegin(); level != results.Levels().rend(); ++level)
  {
    WriteLevel(file, results, level->first);
  }
  file.Commit();
  RemoveFilesIn(this->Folder, place.Level);
}

void SegmentationCheckpoint::Remove()
{
  try
  {
    std::error_code ignored;
    if (!this->Locked && (!fs::exists(this->Folder, ignored) || !this->TakeFolder()))
    {
      return;
    }
  }
  catch (const FileError&)
  {
    return; // Nothing of it is ours.
  }
  RemoveFilesIn(this->Folder);
  this->Locked->RemoveFolder();
  this->Locked.reset();
  this->Existing.reset();
}

std::string SegmentationCheckpoint::FolderInUse() const
{
  return this->Existing ? this->Folder : std::string();
}
}
