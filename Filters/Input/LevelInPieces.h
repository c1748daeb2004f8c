// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelInPieces_h
#define volumicLevelInPieces_h

#include "Core/Image/VoxelPieces.h"

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace volumic
{
/** The voxels of a level that stay with the ranks, each of which has a piece. */
struct LevelInPieces
{
  VoxelPieces Pieces;
  vtkSmartPointer<vtkDataArray> Values; ///< of this rank's, contiguous; null: they were let go
  std::array<double, 2> Range = { 0.0, 0.0 }; ///< of all that are valid (ValidVoxels.h)
  /**
   * Where some are not valid, Values are a copy, floats in which these are background, and which
   * are less this (FieldVoxels.h).
   */
  std::optional<double> Base;
  std::array<float, 2> Extremes = { 0.f, 0.f }; ///< with a Base: the least and largest of Values
  /** PyramidLevels::HashOfVoxels(); 0 where the run is to leave no checkpoints. */
  std::uint64_t Hash = 0;
  std::string AboutNaNs; ///< DescribeNaNs()
  bool HoldsPart = true; ///< of PartThatHolds (ThickPart.h), as far as it matters
};

using LevelsInPieces = std::map<int, LevelInPieces>;
}

#endif
