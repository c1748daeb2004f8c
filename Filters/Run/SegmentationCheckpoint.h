// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationCheckpoint_h
#define volumicSegmentationCheckpoint_h

#include "Core/Evolution/SurfaceAtRest.h"
#include "Output/SegmentationResults.h"
#include "Run/RunFingerprint.h"

#include <memory>
#include <optional>
#include <string>

namespace volumic
{
class FolderLock;

/**
 * What a run leaves on the disk at the end of each level, so that another process can go on from
 * there as if the run had never ended. It is a folder `volumic-<hash>` in the scratch directory,
 * one for each volume and choice of settings, with a file `level-<h>` of the last level: the surface
 * at rest, what the outputs hold so far, and of which run it is. When it is whole, that of the level
 * before goes.
 *
 * A folder in use is locked, for as long as this object or the process lives. It is made with the
 * first checkpoint. What others have put under its name is neither read nor touched: then a run
 * begins anew and leaves none. Errors that end a run are std::invalid_argument; they name the
 * directory, and properties as the panel does.
 */
class SegmentationCheckpoint
{
public:
  /**
   * @param directory the scratch directory; empty: TMPDIR, or /var/tmp
   * @throws where no files can be made in it.
   */
  SegmentationCheckpoint(const std::string& directory, RunFingerprint fingerprint);
  ~SegmentationCheckpoint();
  SegmentationCheckpoint(const SegmentationCheckpoint&) = delete;
  SegmentationCheckpoint& operator=(const SegmentationCheckpoint&) = delete;

  /** Where a run stands. */
  struct Place
  {
    int Level = 0;       ///< the last level at which the surface rests
    bool GoesOn = false; ///< whether it is fit for a finer one
  };

  /**
   * Brings results and surface to where the run was that left the checkpoint. @return nothing,
   * where there is none in the directory: neither has changed.
   * @throws where there are only such of other volumes or settings, telling what differs (of other
   *         volumes only in a directory that was given: the system's is for whatever anyone does);
   *         where another run is at it; where it is damaged.
   */
  std::optional<Place> Load(SegmentationResults& results, SurfaceAtRest& rest);

  /**
   * Keeps where a run stands, unless there is one of the same run that has come further.
   * @return what went wrong, for a warning; then what was there before still is. Once.
   */
  std::string Save(
    const SegmentationResults& results, const SurfaceAtRest& rest, const Place& place);

  /** Removes its files, once the run is over; nothing where another process is at it. */
  void Remove();

  /** The folder, if it holds what a run can go on from; else empty. */
  std::string FolderInUse() const;

  /** The level that Load() has given. */
  std::optional<int> ResumedLevel() const { return this->Resumed; }

private:
  bool TakeFolder();
  void RemoveIfEmpty();
  void CheckOthers() const;
  std::optional<Place> PlaceOfFile() const;
  void Write(
    const SegmentationResults& results, const SurfaceAtRest& rest, const Place& place);

  std::string Directory;
  bool IsShared; ///< The directory is the system's, for whatever anyone does.
  std::string Folder;
  RunFingerprint Fingerprint;
  std::unique_ptr<FolderLock> Locked; ///< null: nothing of the folder is ours
  std::optional<Place> Existing; ///< where the run stood whose files are there
  std::optional<int> Resumed;
  bool HasFailed = false;
};
}

#endif
