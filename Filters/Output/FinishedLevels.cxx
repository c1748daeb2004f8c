// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/FinishedLevels.h"

#include "Core/Common/Join.h"
#include "Output/HistoryTable.h"

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Set a shallow copy, so that the kept surface cannot be changed. */
void SetBlock(
  vtkMultiBlockDataSet* blocks, unsigned int block, const std::string& name, vtkPolyData* surface)
{
  vtkNew<vtkPolyData> copy;
  if (surface)
  {
    copy->ShallowCopy(surface);
  }
  blocks->SetBlock(block, surface ? copy.GetPointer() : nullptr);
  blocks->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), name.c_str());
}
}

bool FinishedLevels::Choose(const ComponentChoice& choice, Executor& threads)
{
  if (choice == this->Choice)
  {
    return true;
  }
  if (std::any_of(this->Levels.begin(), this->Levels.end(),
        [](const auto& level) { return !level.second.All; }))
  {
    return false;
  }
  this->Choice = choice;
  for (auto& level : this->Levels)
  {
    this->MakeSurface(level.second, *level.second.All, threads);
  }
  return true;
}

void FinishedLevels::Add(
  FinishedLevel level, SurfaceResult surface, bool keepsAll, Executor& threads)
{
  if (keepsAll)
  {
    level.All = std::make_shared<const SurfaceResult>(surface);
  }
  this->MakeSurface(level, std::move(surface), threads);
  this->Levels[level.Description.Level] = std::move(level);
}

void FinishedLevels::MakeSurface(
  FinishedLevel& level, SurfaceResult surface, Executor& threads) const
{
  const bool isAny = !surface.Points.empty();
  level.Surface =
    MakePolyData(std::move(surface), level.Description, this->Space, this->Choice, threads);
  level.KeepsNone = isAny && level.Surface->GetNumberOfPoints() == 0;
}

vtkSmartPointer<vtkPolyData> FinishedLevels::LeftOut(int last, Executor& threads) const
{
  const auto found = this->Levels.lower_bound(last);
  if (found == this->Levels.end() || !found->second.All ||
    this->Choice.Mode == KeepComponentsType::AllComponents)
  {
    return nullptr;
  }
  const FinishedLevel& level = found->second;
  ComponentChoice others = this->Choice;
  others.IsInverted = true;
  return MakePolyData(*level.All, level.Description, this->Space, others, threads);
}

void FinishedLevels::Forget(int level)
{
  this->Levels.erase(level);
  this->Snapshots.erase(std::remove_if(this->Snapshots.begin(), this->Snapshots.end(),
                          [level](const auto& snapshot) { return snapshot.first == level; }),
    this->Snapshots.end());
}

bool FinishedLevels::HasConverged(int level) const
{
  const auto found = this->Levels.find(level);
  return found != this->Levels.end() && found->second.IsConverged;
}

vtkSmartPointer<vtkPolyData> FinishedLevels::Outcome(int last) const
{
  const auto finest = this->Levels.lower_bound(last);
  if (finest == this->Levels.end())
  {
    return this->StopReason.empty() ? nullptr : MakeStopped(this->Coarsest, this->StopReason);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(finest->second.Surface);
  if (!this->StopReason.empty())
  {
    SetStopReason(surface, this->StopReason);
  }
  return surface;
}

void FinishedLevels::FillOutputs(int last, vtkInformationVector* outputs) const
{
  vtkNew<vtkMultiBlockDataSet> levels;
  for (int level = this->NumberOfLevels - 1; level >= std::min(last, 0); --level)
  {
    const auto found = this->Levels.find(level);
    const bool isThere = level >= last && found != this->Levels.end();
    // The block of level -1 is the last.
    SetBlock(levels, static_cast<unsigned int>(level < 0 ? this->NumberOfLevels : level),
      Join("Level ", level), isThere ? found->second.Surface.GetPointer() : nullptr);
  }
  if (const vtkSmartPointer<vtkPolyData> finest = this->Outcome(last))
  {
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(finest);
  }
  vtkMultiBlockDataSet::GetData(outputs, 1)->ShallowCopy(levels);
  vtkTable::GetData(outputs, 2)
    ->ShallowCopy(MakeHistoryTable(this->Rows, last, this->Space.WorldUnit()));

  vtkNew<vtkMultiBlockDataSet> snapshots;
  for (const auto& [level, snapshot] : this->Snapshots)
  {
    if (level >= last)
    {
      SetBlock(snapshots, snapshots->GetNumberOfBlocks(), snapshot.first, snapshot.second);
    }
  }
  vtkMultiBlockDataSet::GetData(outputs, 3)->ShallowCopy(snapshots);
}

std::string FinishedLevels::WarningOf(int last, bool warnsOfMissing) const
{
  // Warn only if other settings are necessary. Field data have the rest.
  const auto end = this->Levels.lower_bound(last);
  if (end == this->Levels.end() || !end->second.IsConverged)
  {
    return "";
  }
  const SurfaceDescription& description = end->second.Description;
  if (description.StopReason == Describe(StopReason::Vanished))
  {
    return Join("The surface has vanished at level ", description.Level,
      ": the object is too thin for this level. ",
      this->Coarsest > 0
        ? "Set Coarsest Level to a finer level."
        : "Check Iso Value and Object Is Bright, or resample the image more finely.");
  }
  if (end->second.KeepsNone)
  {
    return Join("The surface of level ", description.Level, " is empty: ",
      this->Choice.Seeds.empty() || this->Choice.Mode != KeepComponentsType::AllComponents
        ? "Keep Components selects none of the components. Choose other components."
        : "no component is at a seed, as the object is too thin there. Set Finest Level to a finer "
          "level, or move the seeds.");
  }
  if (description.Missed.MissingBoundary > NotableFraction && warnsOfMissing)
  {
    const MissedParts& missed = description.Missed;
    const int found = missed.Found + missed.FoundCavities;
    const std::string parts =
      Join(found, found == 1 ? " part" : " parts", " missed by coarser levels");
    const std::string what = missed.Missing == 0 ? "thin ends of " + parts
      : missed.Missing == found                  ? "all of " + parts
                                : Join(missed.Missing, " of ", parts, ", and thin ends of others");
    return Join(std::lround(100.0 * missed.MissingBoundary),
      " % of the object's boundary at level ", description.Level, " is not on the surface: ", what,
      ". They are too thin for triangles of this size, or too near to other parts. ",
      description.Level > 0      ? "Set Finest Level to a finer level."
        : description.Level == 0 ? "Set Finest Level to -1, or resample the image more finely."
                                 : "Resample the image more finely.");
  }
  return "";
}
}
