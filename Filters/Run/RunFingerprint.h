// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunFingerprint_h
#define volumicRunFingerprint_h

#include "Core/Common/CheckedFile.h"
#include "Core/Common/Executor.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationSettings.h"

#include <cstdint>
#include <string>
#include <vector>

namespace volumic
{
/**
 * All that the surface of a level depends on, one by one: the voxels, the settings as
 * PropertyTable.h has them, the other inputs.
 */
class RunFingerprint
{
public:
  RunFingerprint() = default;

  /**
   * @param settings as found for the image, with the level that the run begins at as CoarsestLevel
   * @param levels   with the voxels of all
   */
  RunFingerprint(const SegmentationSettings& settings, const SegmentationRequest& request,
    const SegmentationLevels& levels, Executor& threads);

  /** A hash of all entries: only runs that give the same surfaces have the same one. */
  std::uint64_t Hash() const;

  bool IsSameVolume(const RunFingerprint& other) const;
  /** Tells what differs, as `Iso Value was 20 and is 30; not the same voxels`; empty: nothing. */
  std::string DifferencesFrom(const RunFingerprint& before) const;
  int NumberOfDifferences(const RunFingerprint& other) const;

  /** @throws FileError. */
  void Write(CheckedWriter& file) const;
  static RunFingerprint Read(CheckedReader& file);

private:
  enum class Kind : int
  {
    Volume, ///< Its values tell nobody anything, as those of Hidden.
    Hidden,
    Told,
    Free ///< not a part of it (PropertyTable.h)
  };
  struct Entry
  {
    std::string Name;
    std::string Value;
    Kind Is = Kind::Told;
  };
  void AddVolume(const SegmentationLevels& levels, const ValueRange& range, Executor& threads);
  void AddSettings(const SegmentationSettings& settings);
  void AddInputs(
    const SegmentationRequest& request, const SegmentationLevels& levels, Executor& threads);
  void Add(const std::string& name, const std::string& value, Kind kind = Kind::Hidden);

  struct Difference
  {
    Entry Is;
    std::string Was;
  };
  const std::string* ValueOf(const std::string& name) const;
  /** Of the entries of both: what only some runs have comes with a setting that differs. */
  std::vector<Difference> DifferencesOf(const RunFingerprint& before) const;

  std::vector<Entry> Entries;
};
}

#endif
