// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HistoryTable.h"

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::pair<Phase, const char*> PhaseColumns[] = {
  { Phase::Forces, "ForcesSeconds" },
  { Phase::Contact, "ContactSeconds" },
  { Phase::Proximity, "ProximitySeconds" },
  { Phase::Verification, "VerificationSeconds" },
  { Phase::Remeshing, "RemeshingSeconds" },
  { Phase::Topology, "TopologySeconds" },
  { Phase::Division, "DivisionSeconds" },
};

template <typename Array, typename Get>
void AddColumn(
  vtkTable* table, const char* name, const std::vector<HistoryRow>& rows, const Get& get)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    column->SetValue(static_cast<vtkIdType>(r), get(rows[r]));
  }
  table->AddColumn(column);
}
}

vtkSmartPointer<vtkTable> MakeHistory(
  const std::vector<HistoryRow>& rows, const Workspace& space, bool withPhases)
{
  using Row = HistoryRow;
  const double unit = space.WorldUnit();
  auto table = vtkSmartPointer<vtkTable>::New();
  AddColumn<vtkIntArray>(table, "Iteration", rows, [](const Row& r) { return r.Iteration; });
  AddColumn<vtkIntArray>(table, "Level", rows, [](const Row& r) { return r.Level; });
  AddColumn<vtkIntArray>(table, "Vertices", rows, [](const Row& r) { return r.Vertices; });
  AddColumn<vtkDoubleArray>(
    table, "KineticEnergy", rows, [](const Row& r) { return r.KineticEnergy; });
  AddColumn<vtkDoubleArray>(
    table, "MeanEdgeLength", rows, [unit](const Row& r) { return r.MeanEdgeLength * unit; });
  AddColumn<vtkDoubleArray>(table, "Seconds", rows, [](const Row& r) { return r.Seconds; });
  AddColumn<vtkDoubleArray>(table, "TimeStep", rows, [](const Row& r) { return r.TimeStep; });
  AddColumn<vtkIntArray>(
    table, "ActiveVertices", rows, [](const Row& r) { return r.ActiveVertices; });
  AddColumn<vtkIntArray>(table, "Merges", rows, [](const Row& r) { return r.Merges; });
  AddColumn<vtkIntArray>(table, "Cuts", rows, [](const Row& r) { return r.Cuts; });
  AddColumn<vtkIntArray>(table, "Splits", rows, [](const Row& r) { return r.Splits; });
  AddColumn<vtkIntArray>(table, "Collapses", rows, [](const Row& r) { return r.Collapses; });
  AddColumn<vtkIntArray>(table, "Flips", rows, [](const Row& r) { return r.Flips; });
  AddColumn<vtkIntArray>(
    table, "EulerCharacteristic", rows, [](const Row& r) { return r.EulerCharacteristic; });
  AddColumn<vtkIntArray>(table, "Components", rows, [](const Row& r) { return r.Components; });
  AddColumn<vtkIntArray>(table, "RecoveredParts", rows, [](const Row& r) { return r.Recovered; });
  AddColumn<vtkIntArray>(table, "Deletions", rows, [](const Row& r) { return r.Deletions; });
  AddColumn<vtkIntArray>(table, "DeletedGenus", rows, [](const Row& r) { return r.DeletedGenus; });
  AddColumn<vtkIntArray>(table, "AddedEulerCharacteristic", rows,
    [](const Row& r) { return r.AddedEulerCharacteristic; });
  AddColumn<vtkIntArray>(
    table, "IterationVertices", rows, [](const Row& r) { return r.IterationVertices; });
  AddColumn<vtkDoubleArray>(table, "IterationMeanEdgeLength", rows,
    [unit](const Row& r) { return r.IterationMeanEdgeLength * unit; });
  AddColumn<vtkIntArray>(table, "IterationEulerCharacteristic", rows,
    [](const Row& r) { return r.IterationEulerCharacteristic; });
  AddColumn<vtkIntArray>(
    table, "IterationComponents", rows, [](const Row& r) { return r.IterationComponents; });
  AddColumn<vtkIntArray>(
    table, "RegularisationCuts", rows, [](const Row& r) { return r.RegularisationCuts; });
  AddColumn<vtkIntArray>(
    table, "RegularisationDeletions", rows, [](const Row& r) { return r.RegularisationDeletions; });
  AddColumn<vtkDoubleArray>(
    table, "SecondsBefore", rows, [](const Row& r) { return r.SecondsBefore; });
  AddColumn<vtkDoubleArray>(
    table, "SecondsAfter", rows, [](const Row& r) { return r.SecondsAfter; });
  if (withPhases)
  {
    for (const auto& [phase, name] : PhaseColumns)
    {
      const auto index = static_cast<std::size_t>(phase);
      AddColumn<vtkDoubleArray>(
        table, name, rows, [index](const Row& r) { return r.PhaseSeconds[index]; });
    }
  }
  return table;
}
}
