// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDeformableSurfaceInternals_h
#define vtkDeformableSurfaceInternals_h

#include "Core/Common/Communicator.h"
#include "Host/Deadline.h"
#include "Host/FirstRankWork.h"
#include "Host/LimitedMemory.h"
#include "Run/SegmentationCache.h"
#include "Run/SegmentationCheckpoint.h"
#include "Settings/SegmentationSettings.h"
#include "Settings/SegmentationVolume.h"
#include "vtkDeformableSurface.h"

#include <vtkMultiProcessController.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

/** What vtkDeformableSurface holds, beside what all algorithms do. */
class vtkDeformableSurface::vtkInternals
{
public:
  volumic::SegmentationSettings Settings; ///< the properties
  volumic::LimitedMemory Memory;          ///< as the last run had it; outlives what is kept
  volumic::SegmentationCache Cache;       ///< of the last run
  volumic::Deadline Limit;                ///< of the run
  std::shared_ptr<volumic::SegmentationCheckpoint> Checkpoint; ///< of the last run; null: none
  vtkSmartPointer<vtkMultiProcessController> Controller;
  std::unique_ptr<volumic::Communicator> Ranks;   ///< of the run that is under way
  std::unique_ptr<volumic::FirstRankWork> Alone;  ///< what rank 0 does of it without the others
  volumic::LevelsInPieces InPieces; ///< what this rank has of levels that no rank has whole
  vtkSmartPointer<vtkPolyData> InitialSurface;   ///< of the run, of all ranks
  vtkSmartPointer<vtkPolyData> AttractingPoints; ///< likewise
  std::vector<std::string> Warnings; ///< to be told at the end
  bool LeavesCheckpoints = false; ///< also of runs that have come to their end
  bool HasToldOfWhole = false; ///< that the image does not come in slabs
  bool IsWatched = false;    ///< Someone asks whether a finer level is still to come.
  bool IsOnTheWay = false;   ///< One is, and nobody has asked yet.
  bool GoesToTheEnd = false; ///< The next run shows no level before.
};

#endif
