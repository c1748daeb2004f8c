// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/SegmentationResults.h"

#include "Core/Common/Join.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** A column of the values that `get` gives of each row. */
template <typename Get>
void AddColumn(
  vtkTable* table, const std::string& name, const std::vector<HistoryRow>& rows, const Get& get)
{
  using Value = decltype(get(HistoryRow()));
  vtkNew<std::conditional_t<std::is_same_v<Value, int>, vtkIntArray, vtkDoubleArray>> column;
  column->SetName(name.c_str());
  column->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    column->SetValue(static_cast<vtkIdType>(r), get(rows[r]));
  }
  table->AddColumn(column);
}

/** Return a row per iteration, with the columns that vtkDeformableSurface documents. */
vtkSmartPointer<vtkTable> MakeHistory(const std::vector<HistoryRow>& rows, const Workspace& space)
{
  using Row = HistoryRow;
  auto table = vtkSmartPointer<vtkTable>::New();
  const auto add = [&](const char* name, auto member)
  { AddColumn(table, name, rows, [member](const Row& row) { return row.*member; }); };
  add("Iteration", &Row::Iteration);
  add("Level", &Row::Level);
  add("Vertices", &Row::Vertices);
  add("KineticEnergy", &Row::KineticEnergy);
  AddColumn(table, "MeanEdgeLength", rows,
    [unit = space.WorldUnit()](const Row& row) { return row.MeanEdgeLength * unit; });
  add("Seconds", &Row::Seconds);
  add("TimeStep", &Row::TimeStep);
  add("ActiveVertices", &Row::ActiveVertices);
  add("Merges", &Row::Merges);
  add("Cuts", &Row::Cuts);
  add("Splits", &Row::Splits);
  add("Collapses", &Row::Collapses);
  add("Flips", &Row::Flips);
  add("EulerCharacteristic", &Row::EulerCharacteristic);
  add("Components", &Row::Components);
  return table;
}

void SetBlock(
  vtkMultiBlockDataSet* blocks, unsigned int block, const std::string& name, vtkPolyData* surface)
{
  blocks->SetBlock(block, surface);
  blocks->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), name.c_str());
}

/** What its reader adds or takes away does not change what is kept; the arrays are shared. */
vtkSmartPointer<vtkPolyData> ShallowCopyOf(vtkPolyData* surface)
{
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(surface);
  return copy;
}
}

SegmentationResults::SegmentationResults(
  int numberOfLevels, int coarsest, const Workspace& space, const std::array<int, 3>& size)
  : NumberOfLevels(numberOfLevels), Coarsest(coarsest), Space(space), Size(size)
{
}

bool SegmentationResults::Choose(const SegmentationRequest& request, Executor& threads)
{
  const ComponentChoice choice = ChoiceOf(request, this->Space, this->Size);
  if (choice == this->Choice)
  {
    return true;
  }
  if (std::any_of(this->ByLevel.begin(), this->ByLevel.end(),
        [](const auto& level) { return !level.second.All; }))
  {
    return false;
  }
  this->Choice = choice;
  for (auto& level : this->ByLevel)
  {
    this->MakeSurface(level.second, *level.second.All, threads);
  }
  return true;
}

void SegmentationResults::MakeSurface(Level& result, SurfaceResult surface, Executor& threads) const
{
  const bool isAny = !surface.Points.empty();
  // Each step uses up what the one before has made.
  SurfaceResult kept = KeepChosen(std::move(surface), this->Choice, this->Space, threads);
  result.KeepsNone = isAny && kept.Points.empty();
  result.Surface = MakePolyData(std::move(kept), result.Description, this->Space, threads);
}

void SegmentationResults::Forget(int level)
{
  this->ByLevel.erase(level);
  const auto isOfLevel = [level](const Snapshot& snapshot) { return snapshot.Level == level; };
  this->Snapshots.erase(std::remove_if(this->Snapshots.begin(), this->Snapshots.end(), isOfLevel),
    this->Snapshots.end());
}

void SegmentationResults::AddSnapshot(int level, const std::string& name, vtkPolyData* surface)
{
  this->Snapshots.push_back({ level, name, surface });
}

void SegmentationResults::SetStoppedSurface(vtkPolyData* surface)
{
  this->StoppedSurface = surface;
}

bool SegmentationResults::HasAtRest(int level) const
{
  const auto found = this->ByLevel.find(level);
  return found != this->ByLevel.end() && found->second.IsAtRest;
}

vtkPolyData* SegmentationResults::Outcome(int last) const
{
  if (this->StoppedSurface)
  {
    return this->StoppedSurface;
  }
  const auto finest = this->ByLevel.lower_bound(last);
  return finest == this->ByLevel.end() ? nullptr : finest->second.Surface.GetPointer();
}

void SegmentationResults::FillOutputs(int last, vtkInformationVector* outputs) const
{
  auto levels = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (int level = this->NumberOfLevels - 1; level >= std::min(last, 0); --level)
  {
    const auto found = this->ByLevel.find(level);
    const bool isThere = level >= last && found != this->ByLevel.end();
    // That of level -1 comes after those of the pyramid.
    SetBlock(levels, static_cast<unsigned int>(level < 0 ? this->NumberOfLevels : level),
      Join("Level ", level), isThere ? ShallowCopyOf(found->second.Surface).GetPointer() : nullptr);
  }
  if (vtkPolyData* finest = this->Outcome(last))
  {
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(finest);
  }
  vtkMultiBlockDataSet::GetData(outputs, 1)->ShallowCopy(levels);

  std::vector<HistoryRow> rows;
  std::copy_if(this->Rows.begin(), this->Rows.end(), std::back_inserter(rows),
    [last](const HistoryRow& row) { return row.Level >= last; });
  vtkTable::GetData(outputs, 2)->ShallowCopy(MakeHistory(rows, this->Space));

  auto snapshots = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (const Snapshot& snapshot : this->Snapshots)
  {
    if (snapshot.Level >= last)
    {
      SetBlock(
        snapshots, snapshots->GetNumberOfBlocks(), snapshot.Name, ShallowCopyOf(snapshot.Surface));
    }
  }
  vtkMultiBlockDataSet::GetData(outputs, 3)->ShallowCopy(snapshots);
}

std::string SegmentationResults::WarningOf(int last, bool wantsAll) const
{
  // The field data tell the rest; what is worth a warning needs another choice to be made.
  const auto end = this->ByLevel.lower_bound(last);
  if (end == this->ByLevel.end() || !end->second.IsAtRest)
  {
    return "";
  }
  const SurfaceDescription& about = end->second.Description;
  if (about.StopReason == Describe(StopReason::Vanished))
  {
    return Join("Nothing is left of the surface at level ", about.Level,
      ": the object is too thin for it. ",
      this->Coarsest > 0
        ? "Set Coarsest Level to a finer level."
        : "No level is finer: check Iso Value and Object Is Bright, or resample the image.");
  }
  if (end->second.KeepsNone)
  {
    return Join("Level ", about.Level, ": Keep Components leaves none of the components.");
  }
  if (about.Lost.MissingBoundary > NotableShare && wantsAll)
  {
    const int lost = about.Lost.Found + about.Lost.FoundCavities;
    const std::string parts =
      Join(lost, lost == 1 ? " part" : " parts", " that coarser levels had lost");
    const std::string what = about.Lost.Missing == 0 ? "thin ends of " + parts
      : about.Lost.Missing == lost
      ? "all of " + parts
      : Join(about.Lost.Missing, " of ", parts, ", and thin ends of others");
    return Join(std::lround(100.0 * about.Lost.MissingBoundary),
      " % of the object's boundary at level ", about.Level, " is not on the surface: ", what,
      ", too thin for triangles of this size or too near to the rest. ",
      about.Level > 0
        ? "Set Finest Level to a finer level."
        : (about.Level == 0
              ? "Set Finest Level to -1, which has smaller ones, or resample the image."
              : "Resample the image more finely."));
  }
  return "";
}
}
