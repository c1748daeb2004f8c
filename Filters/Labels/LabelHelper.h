// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelHelper_h
#define volumicLabelHelper_h

#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelMap.h"
#include "Labels/LabelSettings.h"
#include "Labels/LabelSurface.h"
#include "Labels/LabelWork.h"
#include "Ranks/Ranks.h"

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace volumic
{
/** A rank that makes surfaces of labels for the first one, on a thread beside that which answers.
 */
class LabelHelper
{
public:
  /** Settings must outlive it. */
  LabelHelper(const LabelSettings& settings, int numberOfThreads, Ranks::Show show);
  ~LabelHelper();
  LabelHelper(const LabelHelper&) = delete;
  LabelHelper& operator=(const LabelHelper&) = delete;

  /** What a question of the functions below is answered by. */
  RankMessage Answer(RankMessage& message);

  // At the first rank: what it has the others do.

  /** Gives them the map, slice by slice: it may be larger than the room for a copy of it. */
  static void Begin(
    Ranks& ranks, const LabelMap& map, vtkImageData* frame, const std::vector<std::string>& names);
  /** @param own the items of each rank, large ones first; returns at once */
  static void Do(Ranks& ranks, LabelWork::Kind kind, const std::vector<std::uint8_t>& isDue,
    const std::vector<std::vector<std::size_t>>& own);
  struct Told
  {
    LabelProgress Done; ///< of all of them
    bool Stop = false;  ///< One of them is asked to.
    bool AreThrough = true;
  };
  static Told Tell(Ranks& ranks, double share, const std::string& text, bool isStopped);
  /** The surface of an item that a rank has made; none where it was stopped before. */
  static LabelSurface Take(Ranks& ranks, int rank, std::size_t item);
  /** See LabelSurfaceMaker::Lower. */
  static void Lower(Ranks& ranks, const LabelSurfaceMaker::VoxelsOfObjects& voxels,
    const std::vector<std::uint8_t>& areFiner);

private:
  enum class Step : int
  {
    Begin,
    TakeLayer,
    Do,
    Tell,
    Give,
    Lower
  };
  void TakeMap(RankMessage& message);
  void TakeLayer(RankMessage& message);
  void StartWork(RankMessage& message);
  RankMessage TellOfWork(RankMessage& message);
  RankMessage Give(RankMessage& message);

  const LabelSettings& Settings;
  int NumberOfThreads;
  Ranks::Show Show;
  LabelMap Map;
  vtkSmartPointer<vtkImageData> Frame; ///< where the voxels are
  std::vector<std::string> Names;
  int Taken = 0; ///< layers of the map
  std::optional<LabelBricks> Bricks;
  std::optional<LabelSurfaceMaker> Maker;
  std::optional<LabelWork> Work;
  std::future<void> Done; ///< the work that is under way; last, as its end is waited for
};
}

#endif
